#include <cmath>

#include <talus/terramech/mobility/rut.hpp>

namespace talus::terramech {

Soil rutted(const Soil& soil) {
  Soil rut = soil;
  rut.cohesive_modulus *= soil.rut_stiffness;
  rut.frictional_modulus *= soil.rut_stiffness;
  rut.shear_modulus_m /= std::sqrt(soil.rut_stiffness);
  return rut;
}

RefinedModel rutted(const RefinedModel& model) {
  RefinedModel rut = model;
  if (!knowsPasses(model.effects)) rut.soil = rutted(model.soil);
  return rut;
}

}  // namespace talus::terramech
