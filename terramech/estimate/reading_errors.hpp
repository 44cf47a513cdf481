#pragma once

#include <cmath>

#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// Standard deviation of a reading: a part of its value and a part of its own, added in quadrature.
struct ReadingError {
  double relative = 0.0;  ///< [-]
  double absolute = 0.0;  ///< in the reading's unit

  double std(double value) const { return std::hypot(relative * value, absolute); }
};

/// Errors of the four readings; the default is the 5 % on everything that the thesis' simulations use.
struct ReadingErrors {
  ReadingError load{.relative = 0.05};
  ReadingError torque{.relative = 0.05};
  ReadingError sinkage{.relative = 0.05};
  ReadingError slip{.relative = 0.05};

  /// The same relative error [-] on all four.
  static ReadingErrors relative(double share) { return {{share}, {share}, {share}, {share}}; }
};

}  // namespace talus::terramech
