#include <algorithm>
#include <cmath>

#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {
namespace wheel_state_test {

TEST(WheelState, ColumnsByTheirNameInTelemetryFiles) {
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

TEST(WheelState, FurtherColumnsGroupsAndWhatIsNotThere) {
  WheelState s;
  s.extra = {{"moisture", 3.5}};
  s.group = {{"source", "a"}};
  EXPECT_EQ(s.covariate("moisture"), 3.5);
  EXPECT_EQ(s.covariate("source"), 1.0);
  EXPECT_EQ(s.covariate("constant"), 1.0);
  EXPECT_EQ(s.label("source"), "a");
  EXPECT_EQ(s.label("moisture"), "");
  EXPECT_TRUE(std::isnan(s.covariate("no_such_column")));
  EXPECT_TRUE(std::isnan(s.covariate("speed_mps")));  // not known unless it is set
}

}  // namespace wheel_state_test
}  // namespace talus::terramech
