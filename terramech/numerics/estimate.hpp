#pragma once

namespace talus::terramech {

/// Expected value and standard deviation of an uncertain quantity, both in the unit of the quantity.
struct Estimate {
  double value = 0.0;
  double std = 0.0;
};

}  // namespace talus::terramech
