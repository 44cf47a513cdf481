#pragma once

#include <cmath>

#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// Standard deviation of a reading: a relative and an absolute component, added in quadrature.
struct ReadingError {
  double relative = 0.0;  ///< [-]
  double absolute = 0.0;  ///< in the unit of the reading

  /// Returns the standard deviation at a value, in the unit of the reading.
  double std(double value) const { return std::hypot(relative * value, absolute); }
};

/// Errors of the four readings. Default: 5 % of each reading, as in the simulations of the thesis.
struct ReadingErrors {
  ReadingError load{.relative = 0.05};
  ReadingError torque{.relative = 0.05};
  ReadingError sinkage{.relative = 0.05};
  ReadingError slip{.relative = 0.05};

  /// Returns the same relative error [-] for all four readings.
  static ReadingErrors relative(double share) { return {{share}, {share}, {share}, {share}}; }
};

}  // namespace talus::terramech
