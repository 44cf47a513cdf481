#include <cmath>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

double sinkageModulus(const Soil& soil, double width_m) {
  return soil.cohesive_modulus / width_m + soil.frictional_modulus;
}

Soil underGravity(Soil soil, double gravity_m_s2, double exponent) {
  if (soil.test_gravity_m_s2 <= gravity_m_s2) return soil;
  const double factor = std::pow(gravity_m_s2 / soil.test_gravity_m_s2, exponent);
  soil.cohesion_Pa *= factor;
  soil.cohesive_modulus *= factor;
  soil.frictional_modulus *= factor;
  soil.test_gravity_m_s2 = 0.0;
  return soil;
}

void validate(const Soil& soil) {
  const RangeCheck check{"soil '" + soil.name + "'"};
  check.atLeast("cohesion_Pa", soil.cohesion_Pa, 0.0);
  check.within("friction_angle_rad", soil.friction_angle_rad, {0.0, 1.5707963});
  check.above("sinkage_exponent", soil.sinkage_exponent, 0.0);
  check.finite("cohesive_modulus", soil.cohesive_modulus);
  check.finite("frictional_modulus", soil.frictional_modulus);
  check.above("shear_modulus_m", soil.shear_modulus_m, 0.0);
  check.finite("c1", soil.c1);
  check.finite("c2", soil.c2);
  check.above("density_kg_m3", soil.density_kg_m3, 0.0);
  check.within("slip_sinkage_exponent", soil.slip_sinkage_exponent, {0.0, 2.0});
  check.within("digging_exponent", soil.digging_exponent, {0.0, 2.0});
  check.atLeast("side_bulldozing", soil.side_bulldozing, 0.0);
  check.within("rut_stiffness", soil.rut_stiffness, {1.0, 1e3});
  check.within("test_gravity_m_s2", soil.test_gravity_m_s2, {0.0, 1e3});
  // Upper bounds are at least a hundred times the values of any known soil.
  check.within("cohesion_Pa", soil.cohesion_Pa, {0.0, 1e9});
  check.within("sinkage_exponent", soil.sinkage_exponent, {1e-3, 100.0});
  check.within("shear_modulus_m", soil.shear_modulus_m, {1e-9, 1e3});
  check.within("density_kg_m3", soil.density_kg_m3, {0.1, 1e6});
}

}  // namespace talus::terramech
