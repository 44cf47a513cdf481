#pragma once

namespace talus::terramech {

/// A quantity that is not exactly known: its expected value and standard deviation, both in its unit.
struct Estimate {
  double value = 0.0;
  double std = 0.0;
};

}  // namespace talus::terramech
