#include <cmath>

#include <talus/terramech/strength/sojourner.hpp>

namespace talus::terramech {
namespace sojourner_test {

TEST(Sojourner, UniformStressesOverTheChordRecoverTheSoil) {
  // Closed form: W = sigma A, T = r A (c + sigma tan phi) with A = 2 b r sin(theta_1).
  const Wheel wheel{.radius_m = 0.065, .width_m = 0.08};
  MohrCoulombLine line;
  for (const double sigma : {3000.0, 5000.0, 9000.0}) {
    const double z = 0.01;
    const double area = wheel.width_m * 2.0 * wheel.radius_m * std::sin(std::acos(1.0 - z / wheel.radius_m));
    line.add(sojournerPair(wheel, {.load_N = sigma * area,
                                   .torque_Nm = wheel.radius_m * area * (500.0 + 0.7 * sigma),
                                   .sinkage_m = z,
                                   .slip = 1.0}));
  }
  EXPECT_NEAR(line.estimate().cohesion_Pa, 500.0, 1e-9);
  EXPECT_NEAR(line.estimate().tan_friction, 0.7, 1e-12);
}

}  // namespace sojourner_test
}  // namespace talus::terramech
