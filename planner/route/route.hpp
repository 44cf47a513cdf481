#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/mobility/category.hpp>

namespace talus::planner {

/// Result status of planning.
enum class RouteStatus {
  Found,         ///< a route that satisfies every constraint along its whole length
  NoRoute,       ///< start and goal are valid but not connected: proven for all headings
  NoneFound,     ///< no route was found, without proof
  StartInvalid,  ///< the start is outside the map or on a cell that no heading may enter
  GoalInvalid,   ///< the goal or a via point is outside the map or on such a cell
  TimedOut,      ///< the time limit passed before any route was found
  Cancelled,     ///< the caller requested a stop
};

/// Returns the name of the status in files and JSON: "found", "no_route", "none_found", "start_invalid",
/// "goal_invalid", "timed_out", "cancelled".
std::string_view name(RouteStatus status) noexcept;

/// A constraint that can block all routes.
enum class Constraint {
  Pitch,    ///< slope along the heading, limit of the rover
  Roll,     ///< slope across the heading, limit of the rover
  Soil,     ///< strength of soil or motors, or policy, on a slope
  Hazard,   ///< hazards, keep-out areas and the clearance around them
  Unknown,  ///< unobserved ground
  Rim,      ///< clearance from the rim of the map
  Slope,    ///< limits of the rover and soil together; neither alone suffices
};

/// Returns the name of a constraint in files and JSON: "pitch", "roll", "soil", "hazard", "unknown", "rim",
/// "slope".
const char* name(Constraint constraint) noexcept;

/// Returns the name of a hazard in files and JSON: "keep_out" (or refused by a layer), "impassable_class",
/// "rocks", "step", "roughness", otherwise "".
const char* name(costmap::Hazard hazard) noexcept;

/// Cause why no heading may enter a cell: costmap::MapSurface::hazards() of the map from which the costs were
/// computed.
using HazardsOf = std::function<costmap::Hazard(maps::Cell)>;

/// Reason why two places are not connected.
struct Obstruction {
  std::size_t cells_from_start = 0;  ///< cells reachable from the start
  std::size_t cells_to_goal = 0;     ///< cells from which the goal may be reached
  maps::Point last{};                ///< closest cell of the first set: its centre
  maps::Point first{};               ///< closest cell of the second set
  bool tried = false;                ///< true if constraints were tested separately
  /// First constraint whose removal opens a route; empty if no single constraint suffices.
  std::optional<Constraint> lifting{};
  /// If `lifting` is Hazard: the kind whose removal alone, with its clearance, opens a route; empty if
  /// several kinds must be removed. If `lifting` is Slope: Step means that slopes and steps must be removed
  /// together.
  std::optional<costmap::Hazard> hazard{};
};

/// Value of an unknown quantity, such as a layer that the map lacks.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// State of the rover at a point of a route, moving on to the next point (at the last point: as it arrived).
/// Slip, sinkage, torque, margin and category belong to the motion that leaves the vertex.
struct RouteVertex {
  double x_m = 0.0;
  double y_m = 0.0;
  double elevation_m = kNotKnown;           ///< ground elevation; NaN: unknown
  double heading_rad = 0.0;                 ///< counter-clockwise from x (east), (-pi, pi]
  double slope_along_rad = 0.0;             ///< climbing > 0
  double slope_across_rad = 0.0;            ///< left side higher > 0
  double slip = kNotKnown;                  ///< [-], driven > 0, braked < 0
  double slip_angle_rad = kNotKnown;        ///< from the wheel planes to the direction of travel, left > 0
  double side_force_over_load = kNotKnown;  ///< largest of all wheels, over the load of the wheel [-]
  double stability_margin_rad = kNotKnown;  ///< additional tilt until the rover tips
  double sinkage_m = kNotKnown;             ///< sinkage of one wheel, >= 0
  double torque_Nm = kNotKnown;             ///< torque of one wheel
  double drawbar_pull_margin = kNotKnown;   ///< available DP/W minus required DP/W, tan(slope) [-]
  terramech::Category category = terramech::Category::Unknown;
  double energy_J = 0.0;               ///< from the start to this vertex
  double time_s = 0.0;                 ///< from the start to this vertex
  double immobilisation_risk = 0.0;    ///< probability of immobilisation between the start and this vertex, 0
                                       ///< to 1
  double hazard_per_m = 0.0;           ///< hazard rate of immobilisation after this vertex, for independent
                                       ///< metres
  int soil_class = 0;                  ///< class of the ground in the model
  double shared_variance_share = 0.0;  ///< share of the pull variance common to all ground of the class
  bool reverse = false;                ///< reverse motion: heading_rad is opposite to the motion
  double curvature_1_m = 0.0;          ///< curvature of the motion after this vertex, left > 0
  double turn_rad = 0.0;               ///< turn in place before the next motion, left > 0
};

/// Number of manoeuvres, and curvature, of a drive.
struct RouteShape {
  int cusps = 0;  ///< changes between forward and reverse
  int turns_in_place = 0;
  double turned_rad = 0.0;         ///< sum of all changes of heading
  double max_curvature_1_m = 0.0;  ///< at most 1 / turning radius
};

/// Totals and extremes of a route.
struct RouteSummary {
  double cost = 0.0;                  ///< under the cost function [J]: energy + weighted time and risk
  double energy_J = 0.0;              ///< energy of driving
  double time_s = 0.0;                ///< time of driving
  double length_m = 0.0;              ///< along the map plane
  double max_slip = 0.0;              ///< largest magnitude along the route [-]
  double max_slope_rad = 0.0;         ///< steepest inclination along the heading, as a magnitude
  double max_slope_across_rad = 0.0;  ///< steepest inclination across the heading, as a magnitude
  double max_slip_angle_rad = 0.0;    ///< largest magnitude along the route
  double lower_bound = 0.0;           ///< no route between these places has a lower cost; same unit as cost
  double gap = 0.0;                   ///< proven optimality gap cost / lower_bound - 1 [-]
  double proof_s = 0.0;  ///< time for PlanRequest::prove [s]: lower bound and search of other corridors
  std::string planner;   ///< name of the planner
  std::optional<RouteShape> drive{};  ///< if the route observes a turning radius
};

/// A route with all data for reports and controllers.
struct Route {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;        ///< reason and remedy in one line if there is no route; empty when Found
  bool interrupted = false;  ///< a stop was requested; the route is the best so far
  std::optional<Obstruction> obstruction{};  ///< if NoRoute, and two required places are disconnected
  std::size_t goal = 0;  ///< index of the reached goal: 0 is PlanRequest::goal, then the other goals in order
  std::vector<RouteVertex> vertices;
  RouteSummary summary;
  std::shared_ptr<const Route> refused{};  ///< route that failed the check: an error of the planner
};

}  // namespace talus::planner
