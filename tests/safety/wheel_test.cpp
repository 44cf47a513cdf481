#include "wheel.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "pull_curve.hpp"

namespace safety {
namespace {

TEST(SafetyWheel, ForcesMatchTheReferenceCases) {
  std::ifstream file(SAFETY_EQUILIBRIA);
  std::string line;
  std::getline(file, line);
  int cases = 0;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    Soil soil;
    LoadedWheel wheel;
    double sinkage_m, entry, torque_Nm, pull_N;
    in >> soil.cohesion_Pa >> soil.friction_angle_rad >> soil.sinkage_exponent >> soil.frictional_modulus >>
        soil.shear_modulus_m >> soil.c1 >> soil.c2 >> wheel.radius_m >> wheel.width_m >> wheel.load_N >>
        wheel.slip >> sinkage_m >> entry >> torque_Nm >> pull_N;
    const WheelAnswer a = drive(soil, wheel);
    // Closed form: equilibria.csv by independent quadrature, accurate to 1e-8; the adaptive Simpson rule
    // stops at 1e-7 of each piece.
    EXPECT_NEAR(a.sinkage_m, sinkage_m, 1e-6 * wheel.radius_m) << line;
    EXPECT_NEAR(a.torque_Nm, torque_Nm, 1e-5 * wheel.load_N * wheel.radius_m) << line;
    EXPECT_NEAR(a.drawbar_pull_N, pull_N, 1e-5 * wheel.load_N) << line;
    ++cases;
  }
  EXPECT_EQ(cases, 53);
}

TEST(SafetyWheel, InterpolatedCurveMatchesTheModel) {
  const Rover rover{.mass_kg = 176, .gravity_m_s2 = 3.71, .wheel_radius_m = 0.125, .wheel_width_m = 0.16};
  const Soil sand{.cohesion_Pa = 1040,
                  .friction_angle_rad = 0.4887,
                  .sinkage_exponent = 1.1,
                  .cohesive_modulus = 990,
                  .frictional_modulus = 1528430};
  const PullCurve curve(sand, rover);
  for (const double slip : {-0.63, -0.12, 0.03, 0.17, 0.41, 0.5, 0.77})
    for (const double share : {0.8, 1.0}) {
      const LoadedWheel wheel{rover.wheel_radius_m, rover.wheel_width_m, share * rover.wheelLoad_N(), slip};
      const WheelAnswer a = drive(sand, wheel);
      // Property: the interpolation error is part of the allowance of 0.013 in DP/W (judge.hpp).
      EXPECT_NEAR(curve.pull(slip, share), a.drawbar_pull_N / wheel.load_N, 0.003) << slip << ' ' << share;
      EXPECT_NEAR(curve.sinkage(slip, share), a.sinkage_m / wheel.radius_m, 0.003) << slip << ' ' << share;
    }
}

// Property: a slip angle of 0 gives the straight wheel, and the shear stress opposes the sliding: pull, side
// force and torque are bounded by the shear strength.
TEST(SafetyWheel, SlipAngleForcesAreContinuousAtZeroAndMonotone) {
  const Soil sand{.cohesion_Pa = 1040,
                  .friction_angle_rad = 0.4887,
                  .sinkage_exponent = 1.1,
                  .frictional_modulus = 1.5e6};
  for (const double slip : {-0.9, -0.3, 0.2, 0.7}) {
    const WheelAnswer straight = drive(sand, {.load_N = 100, .slip = slip});
    const WheelAnswer turned = drive(sand, {.load_N = 100, .slip = slip, .slip_angle_rad = 1e-5});
    EXPECT_EQ(straight.side_force_N, 0.0);
    EXPECT_NEAR(turned.drawbar_pull_N, straight.drawbar_pull_N, 0.05);
    EXPECT_NEAR(turned.sinkage_m, straight.sinkage_m, 1e-5);
    double last = 0.0;
    for (const double angle : {0.1, 0.3, 0.6}) {
      const WheelAnswer a = drive(sand, {.load_N = 100, .slip = slip, .slip_angle_rad = angle});
      EXPECT_GT(a.side_force_N, last);
      last = a.side_force_N;
    }
  }
}

TEST(SafetyWheel, SoilWithoutBearingCapacityIsReported) {
  const Soil dust{.friction_angle_rad = 0.4, .frictional_modulus = 500};
  EXPECT_FALSE(drive(dust, {}).carried);
}

}  // namespace
}  // namespace safety
