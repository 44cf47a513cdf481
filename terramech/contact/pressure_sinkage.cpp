#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/pressure_sinkage.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m) {
  return sinkageModulus(soil, width_m) * std::pow(depth_m, soil.sinkage_exponent);
}

double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa) {
  const double modulus = sinkageModulus(soil, width_m);
  if (!(modulus > 0.0))
    throw std::domain_error("a soil with modulus " + std::to_string(modulus) + " carries nothing");
  RangeCheck{"pressure-sinkage"}.atLeast("pressure_Pa", pressure_Pa, 0.0);
  return std::pow(pressure_Pa / modulus, 1.0 / soil.sinkage_exponent);
}

}  // namespace talus::terramech
