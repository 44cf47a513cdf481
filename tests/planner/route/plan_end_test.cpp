#include <cmath>
#include <stop_token>

#include <gmock/gmock.h>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/route/plan_end.hpp>

namespace talus::planner {
namespace plan_end_test {

TEST(PlanEnd, FailedPlanHasItsReasonAndNoRoute) {
  const Plan plan = failedPlan(RouteStatus::NoRoute, "walled in");
  EXPECT_EQ(plan.status, RouteStatus::NoRoute);
  EXPECT_EQ(plan.reason, "walled in");
  EXPECT_TRUE(plan.points.empty());
  EXPECT_TRUE(std::isinf(plan.cost_J));
}

// Property: a stop request takes precedence over an elapsed time limit.
TEST(PlanEnd, StoppedPlanNamesItsCause) {
  std::stop_source source;
  const StopCheck late(ProgressMonitor{.progress = {}, .stop = source.get_token()}, 0.0);
  const Plan timed_out = cancelledPlan(late);
  EXPECT_EQ(timed_out.status, RouteStatus::TimedOut);
  EXPECT_THAT(timed_out.reason, ::testing::HasSubstr("time limit"));
  source.request_stop();
  const Plan cancelled = cancelledPlan(late);
  EXPECT_EQ(cancelled.status, RouteStatus::Cancelled);
  EXPECT_THAT(cancelled.reason, ::testing::HasSubstr("cancelled"));
}

}  // namespace plan_end_test
}  // namespace talus::planner
