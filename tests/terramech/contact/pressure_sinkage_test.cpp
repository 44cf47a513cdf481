#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/pressure_sinkage.hpp>

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
  for (const double z :
       {0.0, 1e-4, 0.01, 0.2}) {  // Property: pressure and sinkage are inverse to each other.
    EXPECT_NEAR(bekkerDepth_m(drySand(), 0.1, bekkerPressure_Pa(drySand(), 0.1, z)), z, 1e-15);
  }
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
