#pragma once

#include <cmath>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Standard deviation of a sensor reading, as a relative and an absolute component that add in quadrature.
struct ReadingError {
  double relative = 0.0;  ///< component proportional to the reading [-]
  double absolute = 0.0;  ///< constant component, in the unit of the reading

  /// Returns the standard deviation of a reading with this value, in the unit of the reading.
  double std(double value) const { return std::hypot(relative * value, absolute); }
};

/// Errors of the four readings of a wheel. The default is 5 % of each reading, as in the simulations of the
/// thesis.
struct ReadingErrors {
  ReadingError load{.relative = 0.05};
  ReadingError torque{.relative = 0.05};
  ReadingError sinkage{.relative = 0.05};
  ReadingError slip{.relative = 0.05};

  /// Returns errors with the same relative standard deviation `share` [-] for all four readings.
  static ReadingErrors relative(double share) { return {{share}, {share}, {share}, {share}}; }
};

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
