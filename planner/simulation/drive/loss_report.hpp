#pragma once

#include <string>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// Situation in which a simulated rover was immobilised or slid.
struct LossScene {
  const costmap::TraversabilityMap& map;
  const TrueWorld& world;
  const TrueWorld::Step& step;    ///< last step attempted
  const WheelMeasurements& seen;  ///< latest readings of the wheels
  maps::Point estimated;          ///< estimated position of the rover
  std::string why_it_stopped;     ///< reason of the alarm; empty without an alarm
};

/// One-line description: reason of the stop, number of wheels on ground that no class shows, estimate of the
/// weakest ground under the wheels, and the wheels' readings.
std::string causeOfLoss(const LossScene& scene);

}  // namespace talus::planner
