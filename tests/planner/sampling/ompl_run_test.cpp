#include <cmath>

#include <talus/planner/sampling/ompl_run.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace ompl_run_test {

using testing::drawn;
using ::testing::HasSubstr;

Problem across() {
  return {.map = drawn(std::vector<std::string>(20, std::string(30, '.'))),
          .start = {3.5, 10.5},
          .goal = {26.5, 10.5}};
}

Plan straight(const Problem& leg) {
  Plan known;
  known.points = {leg.start, leg.goal};
  known.cost_J = MotionCost(leg.map).along(known.points);
  known.status = RouteStatus::Found;
  known.lower_bound_J = 200.0;
  return known;
}

// Closed form: on level ground the straight line, 23 m at 10 J/m, is optimal; a known lower bound is kept if
// it is higher than the straight-line bound.
TEST(OmplRun, BestRouteAndHigherBoundAreReturned) {
  const Problem leg = across();
  const Plan plan = runOmpl(leg, {.planner = "RRTstar", .work = 100'000}, straight(leg));
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_NEAR(plan.cost_J, 230.0, 1e-4);
  EXPECT_NEAR(plan.lower_bound_J, 230.0, 1e-4);
  Plan bound = straight(leg);
  bound.lower_bound_J = 229.0;
  Problem near = leg;
  near.goal_tolerance_m = 5.0;  // the straight-line bound is 180 J now
  EXPECT_NEAR(runOmpl(near, {.planner = "RRTstar", .work = 100'000}, bound).lower_bound_J, 229.0, 1e-9);
}

TEST(OmplRun, FailureNamesWhatEndedTheSearch) {
  Problem leg = across();
  std::vector<std::string> rows(20, std::string(30, '.'));
  for (auto& row : rows) row[15] = '#';
  leg.map = drawn(rows);
  const Plan worked = runOmpl(leg, {.planner = "RRTstar", .work = 50'000}, {});
  EXPECT_EQ(worked.status, RouteStatus::NoneFound);
  EXPECT_THAT(worked.reason, HasSubstr("within its work limit; planner 'field' decides"));
  EXPECT_TRUE(worked.points.empty());
  EXPECT_TRUE(std::isinf(worked.cost_J));
  leg.time_limit_s = 0.01;
  const Plan late = runOmpl(leg, {.planner = "RRTstar", .work = 50'000}, {});
  EXPECT_EQ(late.status, RouteStatus::TimedOut);
  EXPECT_THAT(late.reason, HasSubstr("within the time limit"));
}

}  // namespace ompl_run_test
}  // namespace talus::planner
