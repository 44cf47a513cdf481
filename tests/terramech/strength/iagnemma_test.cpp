#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/strength/iagnemma.hpp>

#include "linear_world.hpp"

namespace talus::terramech {
namespace iagnemma_test {

const Wheel kWheel{.radius_m = 0.12, .width_m = 0.09};

ShearStrength estimated(const LinearWorld& world) {
  MohrCoulombLine line;
  for (const WheelSample& s : linearSamples(kWheel, world))
    line.add(iagnemmaPair(kWheel, s, world.shear_modulus_m));
  return line.estimate();
}

TEST(Iagnemma, IsExactIfShearVanishesAtTheBottom) {
  // Property: exact under the method's own assumption, Eq. B.2.
  const ShearStrength fit = estimated({.cohesion_Pa = 1000.0, .tan_friction = 0.6, .offset = false});
  EXPECT_NEAR(fit.cohesion_Pa, 1000.0, 1.0);
  EXPECT_NEAR(fit.tan_friction, 0.6, 1e-4);
}

TEST(Iagnemma, OverestimatesCohesionIfShearActsAtTheBottom) {
  // Property: in a world with shear at the bottom the method overestimates cohesion, the reason for the
  // linear-offset method (thesis Fig. 2.3).
  EXPECT_GT(estimated({.cohesion_Pa = 6000.0, .tan_friction = 0.4}).cohesion_Pa, 7500.0);
}

TEST(Iagnemma, BrakedWheelIsRejected) {
  EXPECT_REFUSED(iagnemmaPair(kWheel, {.load_N = 80, .torque_Nm = -1, .sinkage_m = 0.01, .slip = -0.4}, 0.02),
                 std::domain_error, "no shear mobilised at theta_m; it needs a driven, slipping wheel");
}

}  // namespace iagnemma_test
}  // namespace talus::terramech
