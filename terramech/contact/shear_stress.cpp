#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/shear_stress.hpp>

namespace talus::terramech {

double shearStrength_Pa(const Soil& soil, double normal_Pa) {
  return soil.cohesion_Pa + normal_Pa * std::tan(soil.friction_angle_rad);
}

double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = -std::expm1(-std::abs(displacement_m) / soil.shear_modulus_m);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = std::min(std::abs(displacement_m) / soil.shear_modulus_m, 1.0);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

}  // namespace talus::terramech
