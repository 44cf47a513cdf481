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

// Property: an unknown value is NaN, which compares false with any value; a route that was not planned has
// no vertices.
TEST(Route, UnknownValuesAreNan) {
  const RouteVertex vertex;
  for (const double value :
       {vertex.elevation_m, vertex.slip, vertex.sinkage_m, vertex.torque_Nm, vertex.drawbar_pull_margin})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(vertex.category, terramech::Category::Unknown);
  EXPECT_EQ(Route{}.status, RouteStatus::NoneFound);
}

}  // namespace route_test
}  // namespace talus::planner
