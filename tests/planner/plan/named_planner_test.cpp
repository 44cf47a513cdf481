#include <cmath>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace named_planner_test {

using testing::drawn;
using testing::randomMap;

std::vector<maps::Point> goalsOf(const Problem& problem) {
  std::vector<maps::Point> goals{problem.goal};
  goals.insert(goals.end(), problem.other_goals.begin(), problem.other_goals.end());
  return goals;
}

// Property: the result is the cheapest of the plans to each goal alone, for every kind of planner, with and
// without a via point; its lower bound is valid for each of these plans.
TEST(GoalChoice, ResultIsTheCheapestOfTheSingleGoalPlans) {
  int not_the_first = 0;
  for (const std::string planner : {"field", "hybrid", "RRTstar"})
    for (unsigned seed = 1; seed <= (planner == "RRTstar" ? 1 : 6); ++seed) {  // sampling is slow
      Problem problem{.map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.05}),
                      .start = {20.5, 20.5},
                      .goal = {3.5, 4.5},
                      .other_goals = {{36.5, 5.5}, {20.5, 33.5}, {8.5, 30.5}},
                      .prove = true,
                      .kinematics = {.turning_radius_m = 1.5}};
      if (seed % 2 == 0) problem.via = {{25.5, 25.5}};
      const Plan any = NamedPlanner(planner).plan(problem);
      double best_J = INFINITY;
      std::size_t best = 0;
      const auto goals = goalsOf(problem);
      for (std::size_t k = 0; k < goals.size(); ++k) {
        Problem one = problem;
        one.other_goals.clear();
        one.goal = goals[k];
        const Plan plan = NamedPlanner(planner).plan(one);
        if (plan.status == RouteStatus::Found && plan.cost_J < best_J) best_J = plan.cost_J, best = k;
      }
      if (std::isinf(best_J)) {
        EXPECT_NE(any.status, RouteStatus::Found);
        continue;
      }
      ASSERT_EQ(any.status, RouteStatus::Found) << planner << " seed " << seed << ": " << any.reason;
      EXPECT_EQ(any.cost_J, best_J) << planner << " seed " << seed;
      EXPECT_EQ(any.goal, best) << planner << " seed " << seed;
      const maps::Point end = any.points.back(), goal = goals[any.goal];
      EXPECT_NEAR(std::hypot(end.x_m - goal.x_m, end.y_m - goal.y_m), 0.0, 1e-9);
      EXPECT_LE(any.lower_bound_J, any.cost_J);
      EXPECT_GT(any.lower_bound_J, 0.0);
      not_the_first += best != 0;
    }
  EXPECT_GT(not_the_first, 4);
}

TEST(GoalChoice, UnreachableGoalsAreSkipped) {
  const auto map = drawn({"..........", "..#####...", "..#.#.....", "..###.....", ".........."});
  Problem problem{
      .map = map, .start = {1.5, 2.5}, .goal = {3.5, 2.5}, .other_goals = {{2.5, 2.5}, {8.5, 2.5}}};
  const Plan plan = NamedPlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_EQ(plan.goal, 2u);

  problem.other_goals = {{2.5, 2.5}};
  EXPECT_EQ(NamedPlanner().plan(problem).status, RouteStatus::GoalInvalid);  // the status of the nearest goal
  problem.start = {2.5, 1.5};
  EXPECT_EQ(NamedPlanner().plan(problem).status, RouteStatus::StartInvalid);
}

TEST(GoalChoice, GoalsThatCannotBeCheaperAreNotPlanned) {
  Problem problem{.map = drawn({"............................................................"}),
                  .start = {1.5, 0.5},
                  .goal = {55.5, 0.5},
                  .other_goals = {{3.5, 0.5}}};
  std::vector<maps::Point> asked;
  const Plan plan = planToCheapest(problem, [&](const Problem& one) {
    asked.push_back(one.goal);
    return NamedPlanner().plan(one);
  });
  EXPECT_EQ(plan.goal, 1u);
  EXPECT_EQ(asked, (std::vector<maps::Point>{{3.5, 0.5}}));  // 54 m cost more than 2 m on any ground
}

TEST(GoalChoice, StopsOnRequest) {
  std::stop_source stop;
  Problem problem{
      .map = drawn({"....", "...."}), .start = {0.5, 0.5}, .goal = {3.5, 1.5}, .other_goals = {{2.5, 0.5}}};
  problem.watch.stop = stop.get_token();
  int asked = 0;
  const Plan plan = planToCheapest(problem, [&](const Problem& one) {
    ++asked;
    stop.request_stop();
    return NamedPlanner().plan(one);
  });
  EXPECT_EQ(plan.status, RouteStatus::Cancelled);
  EXPECT_EQ(asked, 1);
}

Problem across(unsigned seed) {
  return {.map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.03, .roughness = 0.1}),
          .start = {3.5, 3.5},
          .goal = {36.5, 35.5},
          .prove = false,
          .kinematics = {.turning_radius_m = 1.5}};
}

TEST(NamedPlanner, DefaultIsTheFieldPlanner) {
  EXPECT_EQ(NamedPlanner().name(), plannerNames().front());
  EXPECT_EQ(NamedPlanner("rrt*").name(), "RRTstar");  // names are matched without case and punctuation
  EXPECT_THROW(NamedPlanner("no-such"), std::invalid_argument);
  EXPECT_THROW(NamedPlanner().plan({}), std::invalid_argument);  // no map
}

// Property: exactly the planners that declare drives return drives.
TEST(NamedPlanner, DrivesAreReturnedExactlyIfDeclared) {
  int drives = 0;
  for (const std::string name : {"field", "hybrid"}) {
    NamedPlanner planner(name);
    Problem problem = across(2);
    const Plan plan = planner.plan(problem);
    ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
    EXPECT_EQ(planner.drives(), !plan.drive.legs.empty()) << name;
    drives += planner.drives();
  }
  EXPECT_EQ(drives, 1);
}

// Property: state kept from one plan does not change the next, also with other maps and goals in between.
TEST(NamedPlanner, ResultIsIndependentOfEarlierPlans) {
  NamedPlanner kept;
  int found = 0;
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (const maps::Point goal : {maps::Point{36.5, 35.5}, {30.5, 5.5}}) {
      Problem problem = across(seed % 2 + 1);
      problem.goal = goal;
      const Plan plan = kept.plan(problem), fresh = NamedPlanner().plan(problem);
      EXPECT_EQ(plan.points, fresh.points);
      EXPECT_EQ(plan.cost_J, fresh.cost_J);
      found += plan.status == RouteStatus::Found;
    }
  EXPECT_GT(found, 3);
}

// Property: each reported cost is lower than the previous one, and the last equals the plan's cost.
TEST(NamedPlanner, ReportsDecreasingCostsWhileSampling) {
  NamedPlanner planner("InformedRRTstar");
  std::vector<double> costs;
  planner.onBetter([&costs](double cost_J) { costs.push_back(cost_J); });
  const Plan plan = planner.plan(across(1));
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  ASSERT_FALSE(costs.empty());
  EXPECT_TRUE(std::ranges::is_sorted(costs, std::greater<>()));
  EXPECT_NEAR(costs.back(), plan.cost_J, 1e-9 * plan.cost_J);
}

TEST(NamedPlanner, StoppedPlanIsMarkedInterrupted) {
  std::stop_source stop;
  Problem problem = across(3);
  problem.watch.stop = stop.get_token();
  NamedPlanner planner("RRTstar");
  EXPECT_FALSE(planner.plan(problem).interrupted);
  planner.onBetter([&stop](double) { stop.request_stop(); });
  const Plan plan = planner.plan(problem);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_TRUE(plan.interrupted);
}

using ::testing::HasSubstr;

// Ground 0: expensive and safe; 1: cheap and risky; 2: as cheap as 1, slower, with half the risk.
std::shared_ptr<const costmap::CostGrid> withRisk(const std::vector<std::string>& rows,
                                                  const costmap::SoilUncertainty& doubt = {}) {
  const auto ground = [](double energy, double time, double risk) {
    costmap::TravelState state;
    state.energy_J_per_m = static_cast<float>(energy);
    state.time_s_per_m = static_cast<float>(time);
    state.risk_per_m = static_cast<float>(risk);
    auto table = std::make_shared<costmap::TabulatedStates>(
        std::vector<costmap::TravelState>(costmap::TravelCurve::kBins, state));
    return costmap::GroundCost{.curve = table->curve({}), .states = table};
  };
  auto content = testing::drawn(rows)->content();
  content.cost = std::make_shared<costmap::TravelCost>(
      costmap::TravelCost::Limits{},
      std::vector{ground(20, 5, 1e-6), ground(10, 5, 1e-2), ground(10, 9, 5e-3)}, doubt);
  return costmap::reweighted(costmap::CostGrid(content), {.energy = 1.0, .time_W = 1.0, .risk_J = 1.0});
}

// Risky ground between start and goal, safe ground around it.
Problem acrossRisk() {
  std::vector<std::string> rows(20, std::string(40, '0'));
  for (std::size_t r = 8; r < 20; ++r) rows[r].replace(5, 30, 30, '1');
  Problem problem;
  problem.map = withRisk(rows);
  problem.start = {2.5, 5.5};
  problem.goal = {37.5, 5.5};
  return problem;
}

double riskOf(const Problem& problem, const Plan& plan) {
  return annotated(plan, {.map = *problem.map, .planner = {}}).vertices.back().immobilisation_risk;
}

TEST(RiskPlanner, RiskLimitIsMetAtHigherCost) {
  const Problem problem = acrossRisk();
  NamedPlanner planner;
  const Plan free = planner.plan(problem);
  ASSERT_EQ(free.status, RouteStatus::Found);
  const double free_risk = riskOf(problem, free);
  EXPECT_NEAR(free_risk, 1 - std::exp(-0.30), 0.01);  // Closed form: 30 m of 1e-2 per metre
  const Plan safe = planWithinRisk(problem, planner, 0.05);
  ASSERT_EQ(safe.status, RouteStatus::Found) << safe.reason;
  EXPECT_LE(riskOf(problem, safe), 0.05);
  EXPECT_GT(safe.cost_J, free.cost_J);
  EXPECT_GE(safe.cost_J, safe.lower_bound_J);
  // Property: the reported cost is the map's own cost, without the price of risk.
  EXPECT_DOUBLE_EQ(safe.cost_J, MotionCost(problem.map).along(safe.points));
}

TEST(RiskPlanner, NonBindingLimitLeavesThePlanUnchanged) {
  const Problem problem = acrossRisk();
  NamedPlanner planner;
  EXPECT_EQ(planWithinRisk(problem, planner, 0.9).points, planner.plan(problem).points);
}

TEST(RiskPlanner, UnsatisfiableLimitReportsTheSafestRoute) {
  Problem problem = acrossRisk();
  problem.map = withRisk(std::vector<std::string>(20, std::string(40, '1')));
  NamedPlanner planner;
  const Plan plan = planWithinRisk(problem, planner, 0.01);
  EXPECT_EQ(plan.status, RouteStatus::NoneFound);
  const std::string safest = std::to_string(riskOf(problem, planner.plan(problem)));
  EXPECT_THAT(plan.reason, HasSubstr("the safest route found has " + safest.substr(0, 4)));
  EXPECT_THROW(planWithinRisk(problem, planner, 0.0), std::invalid_argument);
  EXPECT_THROW(planWithinRisk(problem, planner, 1.0), std::invalid_argument);
}

// Property: the limit is compared with the reported risk of the route, and the unconstrained route is a
// candidate, so that a limit equal to its risk is feasible.
TEST(RiskPlanner, LimitAtTheRiskOfTheUnconstrainedRouteIsFeasible) {
  for (const int columns : {3, 8, 20, 31}) {
    std::vector<std::string> rows(20, std::string(40, '1'));
    for (auto& row : rows)
      row.replace(4, static_cast<std::size_t>(columns), static_cast<std::size_t>(columns), '2');
    Problem problem = acrossRisk();
    problem.map = withRisk(rows, {.correlation_length_m = 5.0, .entrapment = 1.0, .shared = {0.3, 0.3, 0.3}});
    NamedPlanner planner;
    const Plan own = planner.plan(problem);
    const double risk = riskOf(problem, own);
    ASSERT_GT(risk, 0.05);
    const Plan kept = planWithinRisk(problem, planner, risk);
    ASSERT_EQ(kept.status, RouteStatus::Found) << kept.reason;
    EXPECT_LE(riskOf(problem, kept), risk);
    const Plan less = planWithinRisk(problem, planner, 0.999 * risk);
    if (less.status == RouteStatus::Found) {
      EXPECT_LE(riskOf(problem, less), 0.999 * risk);
    }
  }
}

// Requests a stop at the n-th progress report.
Problem stoppedAt(int n, const Problem& problem, std::stop_source& source) {
  Problem stopped = problem;
  stopped.watch = {.progress =
                       [n, &source, calls = std::make_shared<int>(0)](double) {
                         if (++*calls == n) source.request_stop();
                       },
                   .stop = source.get_token()};
  return stopped;
}

// Property: a stopped search makes no statement about prices that were not tried.
TEST(RiskPlanner, StoppedSearchIsReportedAsInterrupted) {
  const Problem problem = acrossRisk();
  int stops = 0;
  for (int n = 1; n < 40; ++n) {
    NamedPlanner planner;
    std::stop_source source;
    const Plan plan = planWithinRisk(stoppedAt(n, problem, source), planner, 0.05);
    if (!source.stop_requested()) break;
    ++stops;
    EXPECT_TRUE(plan.status == RouteStatus::Cancelled ||
                (plan.status == RouteStatus::Found && plan.interrupted))
        << n << ": " << plan.reason;
  }
  EXPECT_GE(stops, 5);
}

}  // namespace named_planner_test

}  // namespace talus::planner
