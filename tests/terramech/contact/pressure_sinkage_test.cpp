#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/pressure_sinkage.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

namespace talus::terramech {
namespace pressure_sinkage_test {

Soil drySand() {
  return {.name = "dry sand",
          .cohesion_Pa = 1040.0,
          .friction_angle_rad = 0.4887,
          .sinkage_exponent = 1.1,
          .cohesive_modulus = 990.0,
          .frictional_modulus = 1528430.0};
}

TEST(PressureSinkage, BekkerPressureIsAPowerOfDepth) {
  const double k = 990.0 / 0.05 + 1528430.0;
  EXPECT_DOUBLE_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.02), k * std::pow(0.02, 1.1));  // Closed form: A.1.
  EXPECT_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.0), 0.0);
}

TEST(PressureSinkage, DepthInvertsPressure) {
  const ReeceSoil reece{.cohesion_Pa = 500.0,
                        .weight_N_m3 = 15000.0,
                        .cohesive_factor = 20.0,
                        .frictional_factor = 300.0,
                        .sinkage_exponent = 0.8};
  for (const double z :
       {0.0, 1e-4, 0.01, 0.2}) {  // Property: pressure and sinkage are inverse to each other.
    EXPECT_NEAR(bekkerDepth_m(drySand(), 0.1, bekkerPressure_Pa(drySand(), 0.1, z)), z, 1e-15);
    EXPECT_NEAR(reeceDepth_m(reece, 0.1, reecePressure_Pa(reece, 0.1, z)), z, 1e-15);
  }
}

TEST(PressureSinkage, ReecePressureDependsOnDepthOverWidthOnly) {
  const ReeceSoil clay{.cohesion_Pa = 5000.0, .cohesive_factor = 15.0, .sinkage_exponent = 0.5};
  // Property: a purely cohesive soil has the same pressure at the same z/b.
  EXPECT_DOUBLE_EQ(reecePressure_Pa(clay, 0.1, 0.02), reecePressure_Pa(clay, 0.3, 0.06));
}

TEST(PressureSinkage, ReeceWeightTermGrowsWithTheWidth) {
  // Closed form: at z = b, p = c k'_c + gamma b k'_phi.
  const ReeceSoil soil{.cohesion_Pa = 500.0,
                       .weight_N_m3 = 15000.0,
                       .cohesive_factor = 20.0,
                       .frictional_factor = 300.0,
                       .sinkage_exponent = 0.8};
  for (const double b : {0.05, 0.2})
    EXPECT_NEAR(reecePressure_Pa(soil, b, b), 500.0 * 20.0 + 15000.0 * b * 300.0, 1e-6);
}

TEST(PressureSinkage, ReeceSoilConvertsToAnEquivalentBekkerSoil) {
  const ReeceSoil reece{.cohesion_Pa = 500.0,
                        .weight_N_m3 = 15000.0,
                        .cohesive_factor = 20.0,
                        .frictional_factor = 300.0,
                        .sinkage_exponent = 0.8};
  const Soil twin = bekkerOf(reece, 0.12, drySand());
  EXPECT_EQ(twin.cohesion_Pa, 500.0);
  EXPECT_EQ(twin.friction_angle_rad, drySand().friction_angle_rad);  // not a parameter of Reece's law
  for (const double z : {0.001, 0.03})
    EXPECT_NEAR(bekkerPressure_Pa(twin, 0.12, z) / reecePressure_Pa(reece, 0.12, z), 1.0, 1e-14);
  EXPECT_GT(equilibrium(twin, {.radius_m = 0.15, .width_m = 0.12}, {.load_N = 60.0, .slip = 0.2}).sinkage_m,
            0.0);
}

TEST(PressureSinkage, SoilWithoutBearingCapacityIsRejected) {
  Soil soil = drySand();
  soil.cohesive_modulus = -1e6;
  EXPECT_REFUSED(bekkerDepth_m(soil, 0.1, 100.0), std::domain_error, "a soil with modulus -8471570");
  EXPECT_REFUSED(bekkerDepth_m(drySand(), 0.1, -1.0), std::invalid_argument,
                 "pressure_Pa = -1, must be >= 0");
}

}  // namespace pressure_sinkage_test
}  // namespace talus::terramech
