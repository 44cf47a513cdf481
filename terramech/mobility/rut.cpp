#include <talus/terramech/mobility/rut.hpp>

namespace talus::terramech {

Soil rutted(const Soil& soil) {
  Soil rut = soil;
  rut.cohesive_modulus *= kReloadStiffness;
  rut.frictional_modulus *= kReloadStiffness;
  rut.shear_modulus_m /= kReloadShear;
  return rut;
}

RefinedModel rutted(const RefinedModel& model) {
  RefinedModel rut = model;
  if (!knowsPasses(model.effects)) rut.soil = rutted(model.soil);
  return rut;
}

}  // namespace talus::terramech
