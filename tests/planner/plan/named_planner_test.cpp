#include <cmath>
#include <stop_token>
#include <string>
#include <vector>

#include <talus/planner/plan/named_planner.hpp>
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

}  // namespace named_planner_test
}  // namespace talus::planner
