#pragma once

#include <cmath>

#include <talus/terramech/contact/wheel_sample.hpp>

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

}  // namespace talus::terramech
