// Shows   estimating soil strength from the readings of a driven wheel, sample by sample, in constant memory.
// Needs   talus::terramech.
// Prints  cohesion and friction angle after every ten samples, and those of the simulated soil.
// Next    rover_loop.cpp: updating the map with the estimates.

#include <cmath>
#include <cstdio>

#include <talus/terramech/terramech.hpp>

namespace {

namespace terramech = talus::terramech;

// Simulated wheel readings at a slip, from the Wong-Reece equilibrium; on a rover the sensors supply them.
terramech::WheelSample measured(const terramech::Soil& soil, const terramech::Wheel& wheel,
                                terramech::WheelOperation operation) {
  const terramech::WheelForces forces = terramech::equilibrium(soil, wheel, operation);
  return {.load_N = operation.load_N,
          .torque_Nm = forces.torque_Nm,
          .sinkage_m = forces.sinkage_m,
          .slip = operation.slip};
}

}  // namespace

int main() {
  const terramech::Soil soil{.name = "dry sand",
                             .cohesion_Pa = 800.0,
                             .friction_angle_rad = 30.0 * talus::kDegree,
                             .sinkage_exponent = 1.1,
                             .cohesive_modulus = 1000.0,
                             .frictional_modulus = 1500000.0,
                             .shear_modulus_m = 0.025};
  const terramech::Wheel wheel{.radius_m = 0.15, .width_m = 0.15};

  terramech::MohrCoulombLine line;
  for (int k = 0; k < 40; ++k) {
    const terramech::WheelOperation operation{.load_N = 60.0 + 3.0 * k, .slip = 0.2 + 0.015 * k};
    line.add(terramech::linearOffset(wheel, measured(soil, wheel, operation), soil.shear_modulus_m).pair());
    if (k % 10 != 9) continue;
    const terramech::ShearStrength strength = line.estimate();
    std::printf("%2d samples: cohesion %5.0f Pa, friction angle %4.1f deg\n", k + 1, strength.cohesion_Pa,
                std::atan(strength.tan_friction) / talus::kDegree);
  }
  std::printf("the soil   : cohesion %5.0f Pa, friction angle %4.1f deg\n", soil.cohesion_Pa,
              soil.friction_angle_rad / talus::kDegree);
  std::puts("what is left is the method's own error: its stresses are straight lines, the wheel's are not");
  return 0;
}
