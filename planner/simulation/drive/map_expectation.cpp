#include <algorithm>
#include <cmath>

#include <talus/planner/simulation/drive/map_expectation.hpp>

namespace talus::planner {

costmap::TravelState MapExpectation::at(const maps::Point& place, const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  const auto grid = map_.published();
  const auto curve = grid->at(*cell).curve();
  return grid->cost().detail(onSlope(curve >= costmap::CellCode::kUnknown ? classCurve(*cell) : curve),
                             heading);
}

costmap::TravelState MapExpectation::ofClass(const maps::Point& place,
                                             const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  if (!cell) return {};
  costmap::TravelState state = at(place, heading);
  const costmap::TravelState of_class = map_.published()->cost().detail(onSlope(classCurve(*cell)), heading);
  state.slip = std::min(state.slip, of_class.slip);
  state.sinkage_m = std::min(state.sinkage_m, of_class.sinkage_m);
  return state;
}

WheelExpectation MapExpectation::ofWheel(const maps::Point& place, const maps::Point& middle,
                                         const costmap::Direction& heading) const {
  const auto cell = map_.grid().cellAt(place);
  const double radius_m = map_.model().rover().wheel.radius_m;
  return {
      .slip = static_cast<double>(ofClass(middle, heading).slip),
      .sinkage_over_radius = static_cast<double>(ofClass(place, heading).sinkage_m) / radius_m,
      .slip_angle_rad =
          cell ? std::abs(map_.published()->cost().hold(onSlope(classCurve(*cell)), heading).slip_angle_rad)
               : 0.0};
}

costmap::CellCode MapExpectation::onSlope(costmap::CellCode::Curve curve) const {
  return costmap::CellCode({.dz_dx = slope_.dzDx(), .dz_dy = slope_.dzDy(), .curve = curve});
}

costmap::CellCode::Curve MapExpectation::classCurve(maps::Cell cell) const noexcept {
  return static_cast<costmap::CellCode::Curve>(std::max(map_.surface().classIndex(cell), 0));
}

}  // namespace talus::planner
