#pragma once

#include <string>

namespace talus::costmap {

struct WheelObservation;

/// Reason why an observation is not physically possible, e.g. "pull = inf, must be ..."; empty if the observation is
/// possible. Limits: |pull|, its standard deviation and |sinkage over radius| <= 100 [-]; coordinates and position
/// uncertainty <= 1e9 m.
std::string fault(const WheelObservation& observation);

}  // namespace talus::costmap
