#pragma once

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {

/// Drive states and wheel readings predicted by the map before a step's readings are used, for ground on the
/// slope at the rover's position, which the rover measures itself. The map must outlive the object.
class MapExpectation {
 public:
  /// `slope`: code of the cell under the rover's centre; only the gradient is used.
  MapExpectation(const costmap::TraversabilityMap& map, costmap::CellCode slope) : map_(map), slope_(slope) {}

  /// Predicted state at a place; of the place's class if the cell is refused; zeros outside the map.
  costmap::TravelState at(const maps::Point& place, const costmap::Direction& heading) const;

  /// Predicted readings of a wheel at a place, assuming ground no weaker than its class, so that ground just
  /// estimated as weak still raises the alarm. `middle`: the rover's centre, whose slip applies to all
  /// wheels.
  WheelExpectation ofWheel(const maps::Point& place, const maps::Point& middle,
                           const costmap::Direction& heading) const;

 private:
  costmap::TravelState ofClass(const maps::Point& place, const costmap::Direction& heading) const;
  costmap::CellCode onSlope(std::uint8_t curve) const;
  std::uint8_t classCurve(maps::Cell cell) const noexcept;

  const costmap::TraversabilityMap& map_;
  costmap::CellCode slope_;
};

}  // namespace talus::planner
