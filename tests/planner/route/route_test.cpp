#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <talus/planner/route/route.hpp>

namespace talus::planner {
namespace route_test {

// The names are part of the documented output format.
TEST(Route, StatusNamesMatchTheFileFormat) {
  const std::pair<RouteStatus, const char*> promised[] = {{RouteStatus::Found, "found"},
                                                          {RouteStatus::NoRoute, "no_route"},
                                                          {RouteStatus::NoneFound, "none_found"},
                                                          {RouteStatus::StartInvalid, "start_invalid"},
                                                          {RouteStatus::GoalInvalid, "goal_invalid"},
                                                          {RouteStatus::TimedOut, "timed_out"},
                                                          {RouteStatus::Cancelled, "cancelled"}};
  for (const auto& [status, word] : promised) EXPECT_EQ(name(status), word);
}

}  // namespace route_test
}  // namespace talus::planner
