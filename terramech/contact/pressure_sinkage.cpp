#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/pressure_sinkage.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

double reeceModulus_Pa(const ReeceSoil& soil, double width_m) {
  return soil.cohesion_Pa * soil.cohesive_factor + soil.weight_N_m3 * width_m * soil.frictional_factor;
}

double depthOf(double pressure_Pa, double modulus, double exponent) {
  if (!(modulus > 0.0))
    throw std::domain_error("a soil with modulus " + std::to_string(modulus) + " carries nothing");
  RangeCheck{"pressure-sinkage"}.atLeast("pressure_Pa", pressure_Pa, 0.0);
  return std::pow(pressure_Pa / modulus, 1.0 / exponent);
}

}  // namespace

double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m) {
  return sinkageModulus(soil, width_m) * std::pow(depth_m, soil.sinkage_exponent);
}

double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa) {
  return depthOf(pressure_Pa, sinkageModulus(soil, width_m), soil.sinkage_exponent);
}

double reecePressure_Pa(const ReeceSoil& soil, double width_m, double depth_m) {
  return reeceModulus_Pa(soil, width_m) * std::pow(depth_m / width_m, soil.sinkage_exponent);
}

double reeceDepth_m(const ReeceSoil& soil, double width_m, double pressure_Pa) {
  return width_m * depthOf(pressure_Pa, reeceModulus_Pa(soil, width_m), soil.sinkage_exponent);
}

Soil bekkerOf(const ReeceSoil& soil, double width_m, const Soil& rest) {
  Soil bekker = rest;
  bekker.cohesion_Pa = soil.cohesion_Pa;
  bekker.sinkage_exponent = soil.sinkage_exponent;
  bekker.cohesive_modulus = 0.0;
  bekker.frictional_modulus = reeceModulus_Pa(soil, width_m) / std::pow(width_m, soil.sinkage_exponent);
  return bekker;
}

}  // namespace talus::terramech
