#pragma once

#include <talus/terramech/contact/soil.hpp>

namespace talus::terramech {

/// Standard deviation of each field of Soil, in the unit of the field; 0: exactly known.
struct SoilDeviation {
  double cohesion_Pa = 0.0;
  double friction_angle_rad = 0.0;
  double sinkage_exponent = 0.0;
  double cohesive_modulus = 0.0;
  double frictional_modulus = 0.0;
  double shear_modulus_m = 0.0;
  double c1 = 0.0;
  double c2 = 0.0;
  double density_kg_m3 = 0.0;
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double rut_stiffness = 0.0;
};

/// Prior of a soil: independent Gaussians of all parameters.
struct SoilPrior {
  Soil mean;
  SoilDeviation deviation;
};

}  // namespace talus::terramech
