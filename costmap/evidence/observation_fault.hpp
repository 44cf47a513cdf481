#pragma once

#include <string>

namespace talus::costmap {

struct WheelObservation;

/// Returns the reason why an observation is not physically possible, e.g. "pull = inf, must be ..."; returns
/// the empty string for a possible observation. Limits: |drawbar pull over load|, its standard deviation and
/// |sinkage over radius| <= 100 [-]; coordinates and position uncertainty <= 1e9 m.
std::string fault(const WheelObservation& observation);

}  // namespace talus::costmap
