#include <limits>
#include <stop_token>

#include <gtest/gtest.h>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {
namespace stop_check_test {

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(StopCheck, WithoutLimitNothingStops) {
  EXPECT_FALSE(StopCheck()());
  EXPECT_FALSE(StopCheck(ProgressMonitor{}, kNever)());
  EXPECT_FALSE(StopCheck(ProgressMonitor{}, 1e300)());  // longer than the clock's range: no overflow
}

TEST(StopCheck, StopRequestAffectsEveryCopy) {
  std::stop_source source;
  const StopCheck check(ProgressMonitor{.progress = {}, .stop = source.get_token()}, kNever), copy = check;
  EXPECT_FALSE(check() || copy());
  source.request_stop();
  EXPECT_TRUE(check() && copy() && copy.cancelled());
  EXPECT_FALSE(copy.timedOut());
}

// Closed form: a time limit of zero has elapsed at once.
TEST(StopCheck, ElapsedTimeLimitIsNotACancellation) {
  const StopCheck check(ProgressMonitor{}, 0.0);
  EXPECT_TRUE(check() && check.timedOut());
  EXPECT_FALSE(check.cancelled());
  EXPECT_EQ(cancelledPlan(check).status, RouteStatus::TimedOut);
}

}  // namespace stop_check_test
}  // namespace talus::planner
