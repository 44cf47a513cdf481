#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include <talus/costmap/wheel_observation.hpp>

namespace talus::costmap {

/// The wheel that a row was read by, as its rover's file has it. NaN: not known.
struct DrivenBy {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  double width_m = std::numeric_limits<double>::quiet_NaN();
  double weight_N =
      std::numeric_limits<double>::quiet_NaN();  ///< of the rover on each of its wheels, on the level
};

/// One telemetry row as the journal keeps it.
struct JournalRow {
  std::string source;            ///< file or vehicle it came from
  std::int64_t line = 0;         ///< in the file
  bool accepted = false;         ///< whether the map learned from it
  std::string reason;            ///< why not; empty when accepted
  WheelReading reading;          ///< as read
  WheelObservation observation;  ///< what it said; of no meaning when refused
  DrivenBy wheel{};              ///< by which it was read
};

/// Why no wheel can have given an observation, "pull = inf, must be ..."; empty where one can. |pull|, its standard
/// deviation and sinkage over radius are within 100, places within 1e9 m.
std::string fault(const WheelObservation& observation);

}  // namespace talus::costmap
