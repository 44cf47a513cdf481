#include <talus/terramech/mobility/rut.hpp>

namespace talus::terramech {

Soil rutted(const Soil& soil) {
  Soil rut = soil;
  rut.cohesive_modulus *= kReloadStiffness;
  rut.frictional_modulus *= kReloadStiffness;
  rut.shear_modulus_m /= kReloadShear;
  return rut;
}

}  // namespace talus::terramech
