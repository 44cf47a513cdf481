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

/// How planning ended. Everything but a failure of the program itself is one of these.
enum class RouteStatus {
  Found,         ///< a route that keeps every constraint along its whole length
  NoRoute,       ///< start and goal stand, and nothing connects them: proven for every heading
  NoneFound,     ///< no route was found, which proves nothing
  StartInvalid,  ///< the start is outside the map or on a cell no heading may enter
  GoalInvalid,   ///< the same of the goal or of a via point
  TimedOut,      ///< the time limit passed before any route was found
  Cancelled,     ///< the caller requested a stop
};

/// The status as files and JSON spell it: "found", "no_route", "none_found", "start_invalid", "goal_invalid",
/// "timed_out", "cancelled".
std::string_view name(RouteStatus status) noexcept;

/// What a mission may do without, or change, to open a way.
enum class Constraint {
  Pitch,    ///< slope along the heading, the rover's limit
  Roll,     ///< slope across the heading, the rover's limit
  Soil,     ///< what the soil, the motors or the policy give at a slope
  Hazard,   ///< hazards, keep-out areas and the clearance around them
  Unknown,  ///< unobserved ground
  Rim,      ///< what is kept clear along the rim of the map
  Slope,    ///< slope that both the rover's limits and the soil refuse: neither alone opens a way
};

/// A constraint as files and JSON spell it: "pitch", "roll", "soil", "hazard", "unknown", "rim", "slope".
const char* name(Constraint constraint) noexcept;

/// A hazard as files and JSON spell it: "keep_out" (or refused by a layer), "impassable_class", "rocks", "step",
/// "roughness", else "".
const char* name(costmap::Hazard hazard) noexcept;

/// Why no heading may enter a cell: costmap::MapSurface::hazards() of the map that the costs were made from.
using HazardsOf = std::function<costmap::Hazard(maps::Cell)>;

/// Why nothing connects two places.
struct Obstruction {
  std::size_t cells_from_start = 0;  ///< that some drive from the start may enter
  std::size_t cells_to_goal = 0;     ///< from which some drive may get to the goal
  maps::Point last{};   ///< where the two sets come closest: middle of a cell reached from the start
  maps::Point first{};  ///< and of one that leads to the goal
  bool tried = false;   ///< whether constraints were lifted one by one
  std::optional<Constraint>
      lifting{};  ///< the first of them without which a way is open; none if no single one is enough
  std::optional<costmap::Hazard>
      hazard{};  ///< of Constraint::Hazard: the kind that is enough alone, with its clearance; none if it takes several.
                 ///< Step with Constraint::Slope: slopes and steps together, neither alone
};

/// A value that is not known: a layer that the map does not have.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// The rover at one point of a route, driving on to the next (at the last one: as it arrived).
/// Slip, sinkage, torque, margin and category belong to the motion that leaves the vertex.
struct RouteVertex {
  double x_m = 0.0;
  double y_m = 0.0;
  double elevation_m = kNotKnown;           ///< of the ground, NaN when not known
  double heading_rad = 0.0;                 ///< counter-clockwise from x (east), (-pi, pi]
  double slope_along_rad = 0.0;             ///< climbing > 0
  double slope_across_rad = 0.0;            ///< left side higher > 0
  double slip = kNotKnown;                  ///< [-], driven > 0, braked < 0
  double slip_angle_rad = kNotKnown;        ///< from the wheels' planes to the way made good, left positive
  double side_force_over_load = kNotKnown;  ///< of the wheel with the greatest, over its load [-]
  double stability_margin_rad = kNotKnown;  ///< further tilt until the rover tips
  double sinkage_m = kNotKnown;             ///< of one wheel, >= 0
  double torque_Nm = kNotKnown;             ///< of one wheel
  double drawbar_pull_margin = kNotKnown;   ///< available DP/W minus required DP/W, tan(slope) [-]
  terramech::Category category = terramech::Category::Unknown;
  double energy_J = 0.0;             ///< from the start to here
  double time_s = 0.0;               ///< from the start to here
  double immobilisation_risk = 0.0;  ///< probability of getting stuck between the start and here, 0 to 1
  double hazard_per_m = 0.0;         ///< of getting stuck on the metres that follow, were each by itself
  int soil_class = 0;                ///< of the ground there, in the model's classes
  double shared_doubt =
      0.0;               ///< share of the variance of its pull that all ground of the class has in common
  bool reverse = false;  ///< drives on backwards: heading_rad is where it looks, not where it goes
  double curvature_1_m = 0.0;  ///< of the motion that leaves the vertex, left > 0
  double turn_rad = 0.0;       ///< turned in place here before going on, left > 0
};

/// What a controller would notice of a drive.
struct DriveShape {
  int cusps = 0;  ///< changes between forward and reverse
  int turns_in_place = 0;
  double turned_rad = 0.0;         ///< all changes of heading
  double max_curvature_1_m = 0.0;  ///< never more than one over the turning radius
};

/// A route as a whole.
struct RouteSummary {
  double cost = 0.0;           ///< under the one cost function, in joules (energy + weighted time and risk)
  double energy_J = 0.0;       ///< of driving
  double time_s = 0.0;         ///< of driving
  double length_m = 0.0;       ///< along the map plane
  double max_slip = 0.0;       ///< largest magnitude along the route [-]
  double max_slope_rad = 0.0;  ///< steepest inclination along the heading, as a magnitude
  double max_slope_across_rad = 0.0;  ///< steepest inclination across the heading, as a magnitude
  double max_slip_angle_rad = 0.0;    ///< largest magnitude along the route
  double lower_bound = 0.0;           ///< no route between these places costs less, same unit as cost
  double gap = 0.0;  ///< cost / lower_bound - 1 [-]: the route is at most so far from the best
  double proof_s =
      0.0;  ///< that PlanRequest::prove took of the planning [s]: the bound and the search of other corridors
  std::string planner;                ///< name of the planner that found it
  std::optional<DriveShape> drive{};  ///< of routes that keep a turning radius
};

/// A route with everything that a report or a controller needs.
struct Route {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;        ///< why there is no route and what to do about it, one line; empty when Found
  bool interrupted = false;  ///< a stop was requested before the work was done: the best route so far
  std::optional<Obstruction>
      obstruction{};     ///< of NoRoute, where two required places are cut off from each other
  std::size_t goal = 0;  ///< where it ends: 0 is PlanRequest::goal, then the other goals in order
  std::vector<RouteVertex> vertices;
  RouteSummary summary;
  std::shared_ptr<const Route> refused{};  ///< what was found but failed the check: an error of the planner
};

}  // namespace talus::planner
