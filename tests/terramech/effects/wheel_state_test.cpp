#include <algorithm>
#include <cmath>

#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {
namespace wheel_state_test {

TEST(WheelState, CovariatesAreFoundByTheirTelemetryColumnName) {
  const WheelState s{.wheel = {.radius_m = 0.1, .width_m = 0.2, .grouser_height_m = 0.3, .grouser_count = 4},
                     .load_N = 5.0,
                     .slip = 0.6,
                     .slip_angle_rad = 0.7,
                     .speed_mps = 8.0,
                     .rim_speed_mps = 9.0,
                     .time_s = 10.0,
                     .pass_index = 11.0,
                     .slope_rad = 12.0};
  const std::vector<std::pair<const char*, double>> expected{
      {"wheel_radius_m", 0.1}, {"wheel_width_m", 0.2}, {"grouser_height_m", 0.3}, {"grouser_count", 4.0},
      {"load_N", 5.0},         {"slip", 0.6},          {"slip_angle_rad", 0.7},   {"speed_mps", 8.0},
      {"rim_speed_mps", 9.0},  {"time_s", 10.0},       {"pass_index", 11.0},      {"slope_rad", 12.0}};
  EXPECT_EQ(stateColumns().size(), expected.size());
  for (const auto& [name, value] : expected) {
    EXPECT_EQ(s.covariate(name), value) << name;
    EXPECT_EQ(std::count(stateColumns().begin(), stateColumns().end(), name), 1) << name;
  }
}

TEST(WheelState, ExtraColumnsAndGroupsAreCovariatesAndUnknownOnesNan) {
  WheelState s;
  s.extra = {{"moisture", 3.5}};
  s.group = {{"source", "a"}};
  EXPECT_EQ(s.covariate("moisture"), 3.5);
  EXPECT_EQ(s.covariate("source"), 1.0);
  EXPECT_EQ(s.covariate("constant"), 1.0);
  EXPECT_EQ(s.label("source"), "a");
  EXPECT_EQ(s.label("moisture"), "");
  EXPECT_TRUE(std::isnan(s.covariate("no_such_column")));
  EXPECT_TRUE(std::isnan(s.covariate("speed_mps")));  // NaN until it is set
}

TEST(WheelState, ProductOfTwoColumnsIsACovariate) {
  WheelState s{.load_N = 40.0};
  s.extra = {{"moisture", 3.5}, {"a*b", 7.0}};
  EXPECT_EQ(s.covariate("moisture*load_N"), 140.0);
  EXPECT_EQ(s.covariate("a*b"), 7.0);  // a column of that name takes precedence
  EXPECT_TRUE(std::isnan(s.covariate("moisture*no_such_column")));
}

TEST(WheelState, SetCovariateRoundTrips) {
  // Property: setCovariate() accepts every column and no other.
  WheelState s;
  s.extra = {{"moisture", 3.5}};
  double value = 1.0;
  for (const std::string& column : stateColumns()) s.setCovariate(column, value += 1.0);
  value = 1.0;
  for (const std::string& column : stateColumns()) EXPECT_EQ(s.covariate(column), value += 1.0) << column;
  s.setCovariate("moisture", 4.5);
  s.setCovariate("no_such_column", 1.0);
  EXPECT_EQ(s.covariate("moisture"), 4.5);
  EXPECT_TRUE(std::isnan(s.covariate("no_such_column")));
}

}  // namespace wheel_state_test
}  // namespace talus::terramech
