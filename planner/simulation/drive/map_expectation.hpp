#pragma once

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {

/// What the map says, before a step's readings are in, of ground on the slope that a rover stands on, which it measures
/// itself. The map must outlive it.
class MapExpectation {
 public:
  /// `slope`: the cell under the rover's middle; of its ground nothing is taken.
  MapExpectation(const costmap::TraversabilityMap& map, costmap::CellCode slope) : map_(map), slope_(slope) {}

  /// At a place; its class says it where the cell is refused, and zeros off the map.
  costmap::DriveState at(const maps::Point& place, const costmap::Direction& heading) const;

  /// Of a wheel at a place, no weaker than its class: ground that was just learned to be weak still gives the alarm.
  /// `middle`: of the rover, whose slip all wheels have.
  WheelExpectation ofWheel(const maps::Point& place, const maps::Point& middle,
                           const costmap::Direction& heading) const;

 private:
  costmap::DriveState ofClass(const maps::Point& place, const costmap::Direction& heading) const;
  costmap::CellCode onSlope(std::uint8_t curve) const;
  std::uint8_t classCurve(maps::Cell cell) const noexcept;

  const costmap::TraversabilityMap& map_;
  costmap::CellCode slope_;
};

}  // namespace talus::planner
