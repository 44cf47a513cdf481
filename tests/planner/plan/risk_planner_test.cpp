#include <memory>
#include <stdexcept>
#include <stop_token>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plan/risk_planner.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace risk_planner_test {

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
    return costmap::GroundCost{.curve = {}, .states = table};
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

}  // namespace risk_planner_test
}  // namespace talus::planner
