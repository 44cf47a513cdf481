#pragma once

#include <string>

namespace talus::costmap {

struct WheelObservation;

/// Why no wheel can have given an observation, "pull = inf, must be ..."; empty where one can. |pull|, its standard
/// deviation and sinkage over radius are within 100, places within 1e9 m.
std::string fault(const WheelObservation& observation);

}  // namespace talus::costmap
