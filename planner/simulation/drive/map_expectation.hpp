#pragma once

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/simulation/drive/wheel_alarm.hpp>

namespace talus::planner {

/// Drive states and wheel readings that the map predicts for a step, before the readings of that step update
/// the map. The slope is that of the cell under the centre of the rover, because the rover measures its own
/// slope. The map must outlive the object.
class MapExpectation {
 public:
  /// `slope` is the code of the cell under the centre of the rover; only the gradient of the ground in this
  /// code is used.
  MapExpectation(const costmap::TraversabilityMap& map, costmap::CellCode slope) : map_(map), slope_(slope) {}

  /// Returns the predicted drive state at `place` on `heading`. If the map excludes the cell of the place,
  /// the state is that of the terrain class of the cell. Outside the map all values are 0.
  costmap::TravelState at(const maps::Point& place, const costmap::Direction& heading) const;

  /// Returns the predicted readings of a wheel at `place`. The ground is assumed to be at least as strong as
  /// its terrain class; otherwise ground that was just estimated as weak would raise no alarm. `middle` is
  /// the centre of the rover; the slip predicted there applies to all wheels.
  WheelExpectation ofWheel(const maps::Point& place, const maps::Point& middle,
                           const costmap::Direction& heading) const;

 private:
  costmap::TravelState ofClass(const maps::Point& place, const costmap::Direction& heading) const;
  costmap::CellCode onSlope(costmap::CellCode::Curve curve) const;
  costmap::CellCode::Curve classCurve(maps::Cell cell) const noexcept;

  const costmap::TraversabilityMap& map_;
  costmap::CellCode slope_;
};

}  // namespace talus::planner
