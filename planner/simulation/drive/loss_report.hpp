#pragma once

#include <string>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// Situation in which a simulated rover was immobilised or slid.
struct LossScene {
  /// Map of the planner at that time.
  const costmap::TraversabilityMap& map;
  /// True soils of the world.
  const TrueWorld& world;
  const TrueWorld::Step& step;    ///< last step that the rover attempted
  const WheelMeasurements& seen;  ///< latest readings of the wheels
  maps::Point estimated;          ///< estimated position of the rover [m]
  std::string why_it_stopped;     ///< reason of the alarm at which the rover stopped; empty without an alarm
};

/// Returns one line of text with the reason of the stop, the number of wheels on soil patches that the map
/// does not contain, the map's estimate of the weakest ground under the wheels, and the readings of the
/// wheels.
std::string causeOfLoss(const LossScene& scene);

}  // namespace talus::planner
