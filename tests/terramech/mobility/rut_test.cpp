#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/mobility/rut.hpp>

namespace talus::terramech {
namespace rut_test {

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

}  // namespace rut_test
}  // namespace talus::terramech
