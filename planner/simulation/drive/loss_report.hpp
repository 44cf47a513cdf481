#pragma once

#include <string>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/worlds/simulated_sensors.hpp>

namespace talus::planner {

/// How a rover was lost.
struct LossScene {
  const costmap::TraversabilityMap& map;
  const TrueWorld& world;
  const TrueWorld::Step& step;  ///< the last one that it tried
  const WheelLook& seen;        ///< what its wheels read when it stopped, or last
  maps::Point believed;         ///< where it took itself to be
  std::string why_it_stopped;   ///< the alarm; empty when nothing gave one
};

/// In one line: what stopped it, how many wheels stand on ground that no class shows, what the map believed
/// of the weakest place under them, what the wheels read.
std::string causeOfLoss(const LossScene& scene);

}  // namespace talus::planner
