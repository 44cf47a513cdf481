#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// What a bare polyline is annotated from.
struct AnnotationInput {
  const costmap::CostGrid& map;
  std::function<std::optional<double>(maps::Point)> elevation_m = nullptr;  ///< none: the map's own
  std::string planner = {};                                                 ///< its name, for the summary
  Kinematics kinematics = {};                                               ///< prices of turning, for drives
  ProgressMonitor watch = {};  ///< when stopped, the risk of a long route is not drawn
};

/// The plan as a route for reports and controllers: a vertex at each turn and wherever the route enters
/// another cell, so that slope, slip and soil of a vertex hold exactly until the next one. Energy and
/// time are integrals of DriveCost::detail along the plan; the risk is riskAlong() of it, or 1 - exp(-sum of
/// hazard rate times length) on maps whose cost does not state how uncertain soil is correlated (SoilDoubt). Of a long
/// route that a stop left undrawn it is riskBoundAlong(), and the route is `interrupted`. A
/// polyline that may not be driven is annotated, too: its cost is infinite, energy and time
/// count what the map provides. A drive has a vertex more wherever an arc is cut into chords, but none for a chord of
/// less than a hundredth of a cell where the way past it may be driven, and two where the rover turns in place; turning
/// counts. Status and reason are the plan's.
Route annotated(const Plan& plan, const AnnotationInput& input);

/// annotated(), once what was found has no violations(), neither of its line nor of its drive where it has one; else NoneFound
/// with the first of them, and the route as Route::refused.
Route checkedRoute(const Plan& plan, const AnnotationInput& input);

/// cost / lower bound - 1; 0 where both are 0, infinite for a bound of 0.
double gapOf(double cost, double lower_bound) noexcept;

}  // namespace talus::planner
