#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::terramech {
namespace measured_slope_test {

// NASA Glenn's MGRU3 on a tilt bed of loose GRC-1 (88 kg, wheels of 0.25 by 0.20 m with 24 lugs of 25 mm;
// 2022, digitised from a secondary source). Values missing in the source are ours.
Rover mgru3(double lug_thrust) {
  Rover rover{.name = "mgru3",
              .mass_kg = 88.0,
              .gravity_m_s2 = 9.81,
              .wheel_count = 4,
              .wheelbase_m = 0.9,
              .track_m = 0.9,
              .clearance_m = 0.25,
              .max_torque_Nm = 200.0};
  rover.wheel = {.radius_m = 0.25,
                 .width_m = 0.2,
                 .grouser_height_m = 0.025,
                 .grouser_count = 24,
                 .lug_thrust = lug_thrust};
  return rover;
}

// The lunar soil recommended by wong_asnani_2008, which GRC-1 simulates; parameters of GRC-1 itself were not
// available.
Soil lunar() {
  return {.name = "lunar_nominal",
          .cohesion_Pa = 170.0,
          .friction_angle_rad = 35.0 * std::numbers::pi / 180.0,
          .sinkage_exponent = 1.0,
          .cohesive_modulus = 1400.0,
          .frictional_modulus = 820000.0,
          .shear_modulus_m = 0.018,
          .density_kg_m3 = 1500.0};
}

// Measured by others: no parameter is fitted to these measurements. The slip is within 0.101 up to 15.3
// degrees; on steeper slopes Talus predicts more slip than measured.
TEST(MeasuredSlope, GrouserWheelSlipOnSlopesMatchesMeasurements) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  if (!folder) GTEST_SKIP() << "TALUS_MEASURED_DATA is not set";
  std::ifstream points(std::filesystem::path(folder) / "slope_slip" / "points.csv");
  ASSERT_TRUE(points);
  const SlopeEquilibrium lugged(lunar(), mgru3(kLugThrust)), smooth(lunar(), mgru3(0.0));
  int held = 0;
  for (std::string line; std::getline(points, line);) {  // source, gravity, load, slope, traction angle, slip
    double slope_deg = 0.0, slip = 0.0;
    if (std::sscanf(line.c_str(), "mgru3_tilt_bed,%*f,%*f,%lf,,%lf", &slope_deg, &slip) != 2) continue;
    const double slope_rad = slope_deg * std::numbers::pi / 180.0;
    if (!(slope_rad > 0.05 && slope_rad < 0.3)) continue;
    const SlopeState state = lugged.at({std::tan(slope_rad), 0.0});
    ASSERT_TRUE(state.holds());
    EXPECT_NEAR(state.slip, slip, 0.105) << slope_deg << " deg";
    EXPECT_LT(state.slip, smooth.at({std::tan(slope_rad), 0.0}).slip);
    ++held;
  }
  EXPECT_EQ(held, 3);
}

}  // namespace measured_slope_test
}  // namespace talus::terramech
