#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/mobility/category.hpp>

namespace talus::costmap {
class GroundModel;
}

/// Constraints on the motion of a rover in the map plane, and costs of turning.

namespace talus::planner {

/// Position and heading of the rover.
struct Pose {
  maps::Point place;         ///< map coordinates [m]
  double heading_rad = 0.0;  ///< heading, counter-clockwise from x (east)
};

/// Path section of constant curvature: a circular arc or a straight line.
struct Arc {
  double length_m = 0.0;       ///< signed length, > 0 forward, < 0 in reverse
  double curvature_1_m = 0.0;  ///< curvature [1/m], > 0 for an arc to the left of the heading
};

/// Returns the pose at the end of an arc that starts at `from`.
Pose after(const Pose& from, const Arc& arc) noexcept;

/// Returns the shortest path without reversing from `from` to `to`, with arcs of the turning radius
/// `radius_m` > 0 (dubins_1957), in the closed forms of shkel_lumelsky_2001. The implementation of OMPL 1.5.2
/// is not used: it compares the length with a bound, which long paths miss by rounding, and then aborts the
/// process.
std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m);

using terramech::TurnEffort;
using terramech::TurnEfforts;

/// Constraints on the curvature of a route, and costs of turning. The default values permit all motions and
/// free turns.
struct Kinematics {
  double turning_radius_m = 0.0;  ///< smallest radius of an arc, 0.001 to 1000; 0: the rover turns in place
  bool may_reverse = true;  ///< true: paths of Reeds and Shepp; false: paths of Dubins, without reversing
  TurnEfforts turns{};      ///< efforts of one radian on ground without an entry in `turns_by_curve`
  /// Efforts of one radian by kind of ground, indexed by CellCode::curve().
  std::vector<TurnEfforts> turns_by_curve{};
  TurnEffort cusp{};  ///< effort of a change between forward and reverse
  TurnEffort stop{};  ///< effort of one turn in place beside its angle: stop, steer the wheels, restart

  /// Returns the efforts of one radian of turning on a cell with CellCode::curve() = `curve`, the index of the
  /// cost curve of its ground.
  const TurnEfforts& turnsOn(costmap::CellCode::Curve curve) const noexcept {
    return curve < turns_by_curve.size() ? turns_by_curve[curve] : turns;
  }
};

/// Returns the kinematics of the rover of `model`, with the turning efforts of `cost`. A change between forward
/// and reverse takes the time in which the rover drives one wheel radius. A stop for a turn in place takes 20
/// s (ours), so that planned routes do not turn at every cell. Throws std::invalid_argument for an Ackermann
/// rover without a turning radius.
Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::TravelCost& cost);

/// Shortest paths between two poses for a turning radius > 0: paths of Reeds and Shepp if the rover may
/// reverse (reeds_shepp_1990, implementation of OMPL), otherwise paths of Dubins. Immutable,
/// safe to share between threads.
class ShortestCurves {
 public:
  /// Throws std::invalid_argument for a radius outside 0.001 to 1000 m.
  explicit ShortestCurves(const Kinematics& kinematics);
  ~ShortestCurves();
  ShortestCurves(ShortestCurves&&) noexcept;

  /// Returns the shortest path from pose `from` to pose `to`, with reversing only if Kinematics::may_reverse
  /// is true.
  std::vector<Arc> operator()(const Pose& from, const Pose& to) const;

  /// Returns the shortest path from `from` to `to` without reversing.
  std::vector<Arc> forward(const Pose& from, const Pose& to) const;

 private:
  struct Spaces;
  std::unique_ptr<const Spaces> spaces_;
  double radius_m_;
  bool may_reverse_;
};

}  // namespace talus::planner
namespace talus::planner {

/// Status of a plan.
enum class RouteStatus {
  Found,         ///< the route satisfies every constraint of the map along its whole length
  NoRoute,       ///< start and goal are valid, but no route connects them: proven for all headings
  NoneFound,     ///< the search found no route; a route may exist
  StartInvalid,  ///< the start lies outside the map or in a cell that the rover may not enter on any heading
  GoalInvalid,   ///< the goal or a via point lies outside the map or in such a cell
  TimedOut,      ///< the time limit passed before a route was found
  Cancelled,     ///< the caller requested a stop before a route was available
};

/// Returns the name of the status in files and JSON: "found", "no_route", "none_found", "start_invalid",
/// "goal_invalid", "timed_out", "cancelled".
std::string_view name(RouteStatus status) noexcept;

/// Constraint of the map that can block all routes.
enum class Constraint {
  Pitch,    ///< limit of the rover for the slope along the heading
  Roll,     ///< limit of the rover for the slope across the heading
  Soil,     ///< soil strength, motor torque or travel policy does not permit the slope
  Hazard,   ///< hazards, keep-out areas, and the clearance around both
  Unknown,  ///< unobserved ground
  Rim,      ///< required clearance from the edge of the map
  Slope,    ///< Pitch, Roll and Soil must be removed together
};

/// Returns the name of the constraint in files and JSON: "pitch", "roll", "soil", "hazard", "unknown", "rim",
/// "slope".
const char* name(Constraint constraint) noexcept;

/// Returns the name of the hazard in files and JSON: "keep_out" (also for a cell that a cost layer excludes),
/// "impassable_class", "rocks", "step", "roughness"; "" for any other hazard.
const char* name(costmap::Hazard hazard) noexcept;

/// Function that returns the hazard for which the rover may not enter a cell on any heading. It is
/// costmap::MapSurface::hazards() of the map from which the costs were computed.
using HazardsOf = std::function<costmap::Hazard(maps::Cell)>;

/// Reason why no route connects two points, here called start and goal.
struct Obstruction {
  std::size_t cells_from_start = 0;  ///< number of cells reachable from the start
  std::size_t cells_to_goal = 0;     ///< number of cells from which the goal is reachable
  /// Centre of the cell reachable from the start that is closest to the cells of cells_to_goal.
  maps::Point last{};
  /// Centre of the cell of cells_to_goal that is closest to the cells of cells_from_start.
  maps::Point first{};
  bool tried = false;   ///< true if the search was repeated with single constraints removed
  bool stated = false;  ///< true: pitch, roll, slope and soil are gradients without a finite stated cost
  /// First constraint whose removal opens a route; empty if the removal of no single constraint opens a
  /// route.
  std::optional<Constraint> lifting{};
  /// If `lifting` is Hazard: the kind of hazard whose removal, with its clearance, opens a route; empty if
  /// several kinds must be removed.
  std::optional<costmap::Hazard> hazard{};
  /// Constraint that must be removed together with `lifting`, neither alone; empty if `lifting` alone suffices.
  std::optional<Constraint> also{};
};

/// Value of a quantity that is not known, for example because the map lacks a layer.
inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// State of the rover at a vertex of a route. Slopes, slip, sinkage, torque, margin and category apply to the
/// motion from this vertex to the next vertex; at the last vertex, to the motion that ends there.
struct RouteVertex {
  double x_m = 0.0;                   ///< map coordinate, east
  double y_m = 0.0;                   ///< map coordinate, north
  double elevation_m = kNotKnown;     ///< ground elevation; NaN: unknown
  double heading_rad = 0.0;           ///< heading of the rover, counter-clockwise from x (east), (-pi, pi]
  double slope_along_rad = 0.0;       ///< inclination along the direction of motion, climbing > 0
  double slope_across_rad = 0.0;      ///< inclination across the direction of motion, left side higher > 0
  double slip = kNotKnown;            ///< wheel slip [-], driven > 0, braked < 0
  double slip_angle_rad = kNotKnown;  ///< angle from the wheel planes to the direction of travel, left > 0
  double side_force_over_load = kNotKnown;  ///< largest |side force| / load of all wheels [-]
  double stability_margin_rad = kNotKnown;  ///< additional tilt at which the rover tips
  double sinkage_m = kNotKnown;             ///< wheel sinkage, >= 0
  double torque_Nm = kNotKnown;             ///< drive torque of one wheel
  /// Available DP/W (drawbar pull over load) minus required DP/W = tan(slope) [-].
  double drawbar_pull_margin = kNotKnown;
  terramech::Category category = terramech::Category::Unknown;  ///< traversability category of the motion
  double energy_J = 0.0;  ///< expected energy from the start to this vertex
  double time_s = 0.0;    ///< expected driving time from the start to this vertex
  /// Probability of immobilisation between the start and this vertex, [0, 1].
  double immobilisation_risk = 0.0;
  /// Rate of immobilisation [1/m] after this vertex, if every metre of soil is independent.
  double hazard_per_m = 0.0;
  int soil_class = 0;  ///< number of the terrain class of the ground
  /// Share of the variance of DP/W that is common to all ground of the class, [0, 1].
  double shared_variance_share = 0.0;
  bool reverse = false;  ///< true: the rover drives in reverse, and heading_rad is opposite to the motion
  double curvature_1_m = 0.0;  ///< curvature [1/m] of the motion after this vertex, left > 0
  double turn_rad = 0.0;       ///< angle of the turn in place at this vertex, left > 0
};

/// Number of manoeuvres of a drive (a route with arcs, reversing and turns in place), and its largest
/// curvature.
struct RouteShape {
  int cusps = 0;                   ///< number of changes between forward and reverse
  int turns_in_place = 0;          ///< number of turns in place
  double turned_rad = 0.0;         ///< sum of the magnitudes of all changes of heading
  double max_curvature_1_m = 0.0;  ///< largest magnitude of curvature, at most 1 / turning radius
};

/// Totals and extreme values of a route.
struct RouteSummary {
  double cost = 0.0;           ///< value of the cost function [J]: energy + weighted time + weighted risk
  double energy_J = 0.0;       ///< total energy, expected
  double time_s = 0.0;         ///< total driving time, expected
  double energy_p90_J = 0.0;   ///< energy that the drive does not exceed with the probability 0.9
  double time_p90_s = 0.0;     ///< time that the drive does not exceed with the probability 0.9
  double length_m = 0.0;       ///< length in the map plane
  double max_slip = 0.0;       ///< largest magnitude of wheel slip [-]
  double max_slope_rad = 0.0;  ///< largest magnitude of the inclination along the heading
  double max_slope_across_rad = 0.0;  ///< largest magnitude of the inclination across the heading
  double max_slip_angle_rad = 0.0;    ///< largest magnitude of the slip angle
  /// Proven lower bound of the cost of all routes between these points, same unit as cost.
  double lower_bound = 0.0;
  double gap = 0.0;  ///< proven optimality gap cost / lower_bound - 1 [-]
  /// Time [s] for PlanRequest::prove: improved lower bound and search over points of cells.
  double proof_s = 0.0;
  std::string planner;  ///< name of the planner
  /// Manoeuvres of a drive; empty for a polyline without arcs and turns in place.
  std::optional<RouteShape> drive{};
};

/// Result of planning with all data for reports and controllers.
struct Route : RouteSummary {
  RouteStatus status = RouteStatus::NoneFound;
  /// One line with the reason and a remedy if there is no route; empty if the status is Found.
  std::string reason;
  bool interrupted = false;  ///< true: a stop was requested, and the route is the best found until then
  std::optional<Obstruction> obstruction{};  ///< reason of NoRoute, if two required points are not connected
  std::size_t goal = 0;  ///< index of the reached goal: 0 is PlanRequest::goal, k > 0 is other_goals[k - 1]
  std::vector<RouteVertex> vertices;  ///< vertices from start to goal
  /// Route rejected by the route check, which is an error of the planner; else null.
  std::shared_ptr<const Route> refused{};

  /// Returns true if the status is Found.
  bool found() const noexcept { return status == RouteStatus::Found; }
};

}  // namespace talus::planner
