#include <talus/common/common.hpp>
#include <talus/terramech/calibration/table/model_rows.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace model_rows_test {

constexpr double kNone = WheelState::kUnknown;

/// Rows of a wheel of radius 0.1 m: load, slip, sinkage, side force, slip angle.
Telemetry table() {
  MadeRows rows(
      {"load_N", "slip", "sinkage_m", "side_force_N", "slip_angle_rad", "wheel_radius_m", "wheel_width_m"});
  for (const auto& [sinkage_m, force_N, angle_rad] :
       {std::tuple{0.01, kNone, kNone}, std::tuple{0.02, 5.0, kNone}, std::tuple{0.01, 5.0, 0.2},
        std::tuple{0.12, kNone, kNone}, std::tuple{0.01, 0.0, kNone}})
    rows.add({50.0, 0.2, sinkage_m, force_N, angle_rad, 0.1, 0.1});
  return rows.telemetry();
}

TEST(ModelRows, SideForceRequiresSlipAngle) {
  const ModelRows rows = modelRows(table(), {});
  ASSERT_EQ(rows.rejected.size(), 1U);
  EXPECT_EQ(rows.rejected[0].line, 3U);
  EXPECT_THAT(rows.rejected[0].reason, testing::HasSubstr("side_force_N = 5 without slip_angle_rad"));
}

TEST(ModelRows, RowsBeyondTheAxleAreSeparated) {
  const ModelRows rows = modelRows(table(), {});
  EXPECT_EQ(rows.trial.rows(), 3);
  ASSERT_EQ(rows.beyond_axle.rows(), 1);
  EXPECT_NEAR(rows.beyond_axle.measured(0, 1), 1.2, 1e-12);
}

TEST(ModelRows, WheelComesFromTheRoverAndSoilIsUnknownWithoutName) {
  const ModelFile none = baseModel("", "");
  EXPECT_FALSE(none.soil_given);
  EXPECT_FALSE(none.model.wheel);
  const ModelFile sand = baseModel("sand", "fido");
  EXPECT_TRUE(sand.soil_given);
  ASSERT_TRUE(sand.model.wheel);
  EXPECT_EQ(sand.model.wheel->radius_m, loadRover("fido").wheel.radius_m);
}

}  // namespace model_rows_test
}  // namespace talus::terramech
