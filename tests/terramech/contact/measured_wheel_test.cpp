#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {
namespace measured_wheel_test {

struct Errors {
  double side = 0.0, pull = 0.0, sinkage = 0.0;  // root mean square errors of side force and pull over load,
                                                 // and of sinkage over radius
  int runs = 0;
};

// RMS errors over the driven runs of the smooth wheel at a slip angle (cmu_testbed, Pavlov and Johnson),
// with the slip in the wheel's plane.
Errors errorsAt(double angle_deg, const Soil& soil, const std::string& path) {
  std::ifstream runs(path);
  Errors errors;
  for (std::string line; std::getline(runs, line);) {
    double slip = 0.0, beta = 0.0, v = 0.0, rim = 0.0, load = 0.0, z = 0.0, pull = 0.0, side = 0.0, r = 0.0,
           b = 0.0;
    if (std::sscanf(line.c_str(), "smooth_%*[^,],smooth,%*[^,],%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf",
                    &slip, &beta, &v, &rim, &load, &z, &pull, &side, &r, &b) != 10)
      continue;
    if (slip < 0.0 || std::abs(std::abs(beta) * 180.0 / std::numbers::pi - angle_deg) > 4.0) continue;
    const double along = v * std::cos(beta);
    const WheelForces f = equilibrium(soil, {.radius_m = r, .width_m = b},
                                      {.load_N = load,
                                       .slip = rim >= along ? 1.0 - along / rim : rim / along - 1.0,
                                       .slip_angle_rad = beta,
                                       .gravity_m_s2 = 9.81});
    errors.side += std::pow((f.side_force_N - side) / load, 2);
    errors.pull += std::pow((f.drawbar_pull_N - pull) / load, 2);
    errors.sinkage += std::pow((f.sinkage_m - z) / r, 2);
    ++errors.runs;
  }
  for (double* sum : {&errors.side, &errors.pull, &errors.sinkage})
    *sum = std::sqrt(*sum / std::max(1, errors.runs));
  return errors;
}

// Measured by others: the soil of the authors (cohesion estimated, friction measured, k and n from plate
// tests). Three parameters, K, c1 and the slip sinkage, are fitted to the runs at 0 degrees only.
// docs/slopes.md states the errors at 45 degrees, where the goals are missed.
TEST(MeasuredWheel, ThreeParametersFittedStraightPredictRunsAt15Degrees) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  if (!folder) GTEST_SKIP() << "TALUS_MEASURED_DATA is not set";
  const std::string runs = std::filesystem::path(folder) / "cmu_testbed" / "runs.csv";
  Soil soil{.name = "testbed",
            .cohesion_Pa = 1000.0,
            .friction_angle_rad = 29.0 * std::numbers::pi / 180.0,
            .sinkage_exponent = 1.44,
            .frictional_modulus = 9.3e6,
            .shear_modulus_m = 0.0092,
            .c1 = 0.354,
            .slip_sinkage_exponent = 0.11};
  for (const double angle_deg : {0.0, 15.0}) {
    const Errors errors = errorsAt(angle_deg, soil, runs);
    ASSERT_GE(errors.runs, 9);
    EXPECT_LT(errors.side, 0.05) << angle_deg;
    EXPECT_LT(errors.pull, 0.04) << angle_deg;
    EXPECT_LT(errors.sinkage, 0.03) << angle_deg;
  }
  // Property: without slip sinkage the predicted sinkage is too small.
  soil.slip_sinkage_exponent = 0.0;
  for (const double angle_deg : {0.0, 15.0, 45.0})
    EXPECT_GT(errorsAt(angle_deg, soil, runs).sinkage, 0.07) << angle_deg;
}

}  // namespace measured_wheel_test
}  // namespace talus::terramech
