#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::terramech {

namespace wheel_forces_table_test {

TEST(Rut, SecondPassSinksLessAndPullsMore) {
  const Soil sand{.name = "sand",
                  .cohesion_Pa = 800.0,
                  .friction_angle_rad = 0.63,
                  .sinkage_exponent = 1.0,
                  .cohesive_modulus = 1400.0,
                  .frictional_modulus = 820000.0,
                  .shear_modulus_m = 0.015};
  const Wheel wheel{.radius_m = 0.12, .width_m = 0.12};
  for (const double slip : {0.1, 0.3, 0.6}) {
    const WheelForces first = equilibrium(sand, wheel, {.load_N = 56.0, .slip = slip});
    const WheelForces second = equilibrium(rutted(sand), wheel, {.load_N = 56.0, .slip = slip});
    // Property: the sinkage is reduced by the factor 4^(2/(2n + 1)), and the resistance in proportion to the
    // root of the sinkage.
    EXPECT_NEAR(second.sinkage_m / first.sinkage_m, 0.397, 0.03) << slip;
    EXPECT_GT(second.drawbar_pull_N, first.drawbar_pull_N) << slip;
  }
}

Rover rover() {
  return {.name = "box",
          .mass_kg = 40.0,
          .gravity_m_s2 = 3.71,
          .wheel_count = 4,
          .wheel = {.radius_m = 0.12, .width_m = 0.1},
          .wheelbase_m = 0.8,
          .track_m = 0.7,
          .clearance_m = 0.2,
          .max_torque_Nm = 40.0};
}

Soil soil(int kind) {
  Soil s{.name = "soil",
         .cohesion_Pa = 200.0,
         .friction_angle_rad = 0.55,
         .sinkage_exponent = 1.0,
         .frictional_modulus = 8e5,
         .shear_modulus_m = 0.018};
  if (kind == 1) s.cohesion_Pa = 7000.0, s.friction_angle_rad = 0.44, s.sinkage_exponent = 0.7;
  if (kind == 2) s.shear_modulus_m = 0.01;
  return s;
}

TEST(WheelForcesTable, MatchesTheWheel) {
  std::mt19937_64 engine{4};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine);
  };
  for (const int kind : {0, 1, 2}) {
    const WheelForcesTable table{soil(kind), rover()};
    std::vector<double> errors;
    for (int k = 0; k < 400; ++k) {
      const WheelMotion m{wheelLoad_N(rover()) * between(0.3, 4.0), between(-0.95, 0.9), between(-0.8, 0.8)};
      const WheelForces f = equilibrium(soil(kind), rover().wheel,
                                        {.load_N = m.load_N,
                                         .slip = m.slip,
                                         .slip_angle_rad = m.slip_angle_rad,
                                         .gravity_m_s2 = rover().gravity_m_s2});
      const WheelRatios t = table.at(m);
      const double r = rover().wheel.radius_m;
      errors.push_back(std::max({std::abs(t.value[kPullRatio] - f.drawbar_pull_N / m.load_N),
                                 std::abs(t.value[kSideRatio] - f.side_force_N / m.load_N),
                                 std::abs(t.value[kTorqueRatio] - f.torque_Nm / (m.load_N * r)),
                                 std::abs(t.value[kSinkageRatio] - f.sinkage_m / r)}));
    }
    std::sort(errors.begin(), errors.end());
    // Property: the errors are within those stated in the header.
    EXPECT_LT(errors.back(), 0.015) << kind;
    EXPECT_LT(errors[errors.size() / 2], 0.001) << kind;
  }
}

TEST(WheelForcesTable, DerivativesMatchFiniteDifferences) {
  const WheelForcesTable table{soil(0), rover()};
  const double h = 1e-6;
  for (const double slip : {-0.72, -0.01, 0.33, 0.81})
    for (const double angle : {-0.4, -0.02, 0.0, 0.3}) {
      const WheelRatios at = table.at({30.0, slip, angle});
      const WheelRatios more = table.at({30.0, slip + h, angle}), left = table.at({30.0, slip, angle + h});
      for (std::size_t c = 0; c < kWheelChannels; ++c) {
        // Property: the derivatives equal finite differences of the same cubic.
        EXPECT_NEAR(at.by_slip[c], (more.value[c] - at.value[c]) / h, 1e-4);
        EXPECT_NEAR(at.by_angle[c], (left.value[c] - at.value[c]) / h, 1e-4);
      }
    }
}

TEST(WheelForcesTable, ModelWithoutEffectsEqualsItsSoil) {
  RefinedModel model;
  model.soil = soil(0);
  const WheelForcesTable a{soil(0), rover()}, b{model, rover()};
  for (const double slip : {-0.5, 0.2})
    for (const double angle : {0.0, 0.3})
      for (std::size_t c = 0; c < kWheelChannels; ++c)
        // Property: two solvers of one wheel agree; 1e-5 for the faster rule of effects.
        EXPECT_NEAR(a.at({30.0, slip, angle}).value[c], b.at({30.0, slip, angle}).value[c], 1e-4);
}

}  // namespace wheel_forces_table_test

}  // namespace talus::terramech
