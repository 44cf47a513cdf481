#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Input of annotated() in addition to the plan.
struct AnnotationInput {
  /// Cost map on which the plan was made.
  const costmap::CostGrid& map;
  /// Elevation [m] at a map position; null: the elevation of the map.
  std::function<std::optional<double>(maps::Point)> elevation_m = nullptr;
  std::string planner = {};    ///< name of the planner for the summary
  Kinematics kinematics = {};  ///< costs of turning, for drives with arcs
  HazardsOf hazards = {};      ///< as in Problem::hazards, for the wheels at the ends of the route
  ProgressMonitor watch = {};  ///< requests a stop, after which the risk of a long route is not simulated
};

/// Converts a plan to a route for reports and controllers. The route has a vertex at each turn and at each
/// entry into another cell; slope, slip and soil of a vertex apply until the next vertex. Energy and time are
/// integrals of TravelCost::detail() along the plan. The risk is that of riskAlong(). If the cost function of
/// the map has no correlation length of the soil (SoilUncertainty), the risk is 1 - exp(-sum of hazard rate
/// times length). If a stop ends the simulation of a long route, the risk is that of riskBoundAlong(), and
/// the route is marked `interrupted`. A polyline that is not allowed is converted, too: its cost is infinite,
/// and its energy and time include only the cells with finite values. A drive (route with arcs) has an
/// additional vertex at each chord of an arc, except chords shorter than a hundredth of a cell that can be
/// omitted, and two vertices at each turn in place; its energy and time include turns. Status and reason are
/// those of the plan.
Route annotated(const Plan& plan, const AnnotationInput& input);

/// Returns the annotated() route if the plan is not Found or has neither violations() nor violationsAtEnds().
/// Otherwise returns a route with status NoneFound, the first violation as reason, and the annotated route in
/// Route::refused.
Route checkedRoute(const Plan& plan, const AnnotationInput& input);

/// Returns the optimality gap cost / lower_bound - 1: 0 if both are 0, infinite if only the lower bound is 0.
double gapOf(double cost, double lower_bound) noexcept;

}  // namespace talus::planner
