#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/check/route_ends.hpp>
#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace {

using costmap::Direction;
using maps::Point;

// Vertices closer than this share of a cell are merged.
constexpr double kTogether = 1e-2;

// [cells] Shorter pieces result from rounding of a vertex on a cell side and are ignored.
constexpr double kRounding = 1e-9;

// Sorted shares of a segment at which it crosses from cell to cell, including 0 and 1.
std::vector<double> passages(const maps::Grid& grid, const Segment& motion) {
  std::vector<double> shares{0.0, 1.0};
  // Only grid lines of the map: a section outside the map is one piece.
  const auto add = [&](double from, double to, int lines) {
    const double first = std::max(std::ceil(std::min(from, to)), 0.0);
    const double last = std::min(std::max(from, to), static_cast<double>(lines));
    for (double line = first; line <= last && from != to; line += 1.0)
      shares.push_back((line - from) / (to - from));
  };
  const Point corner = grid.south_west;
  add((motion.from.x_m - corner.x_m) / grid.resolution_m, (motion.to.x_m - corner.x_m) / grid.resolution_m,
      grid.width);
  add((motion.from.y_m - corner.y_m) / grid.resolution_m, (motion.to.y_m - corner.y_m) / grid.resolution_m,
      grid.height);
  std::sort(shares.begin(), shares.end());
  return shares;
}

// Drive properties of a straight piece. `heading` is the heading of the pose on a chord; the ends of a very
// short chord do not determine a heading.
struct Motion {
  bool reverse = false;
  double curvature_1_m = 0.0;
  std::optional<Direction> heading{};
};

class Annotator {
 public:
  explicit Annotator(const AnnotationInput& input)
      : input_(input), grid_(input.map.grid()), cost_({std::shared_ptr<const void>(), &input.map}) {}

  void drive(const Segment& motion, const Motion& how = {}) {
    how_ = how;
    const double length_m = std::hypot(motion.to.x_m - motion.from.x_m, motion.to.y_m - motion.from.y_m);
    if (!(length_m > 0.0)) return;
    const Direction along{(motion.to.x_m - motion.from.x_m) / length_m,
                          (motion.to.y_m - motion.from.y_m) / length_m};
    const Direction heading = length_m < kTogether * grid_.resolution_m ? how.heading.value_or(along) : along;
    const auto shares = passages(grid_, motion);
    double emitted = -1.0;
    for (std::size_t i = 1; i < shares.size(); ++i) {
      const double metres = (shares[i] - shares[i - 1]) * length_m;
      if (!(metres > kRounding * std::min(length_m, grid_.resolution_m))) continue;
      const auto at = [&](double share) {
        const auto between = [&](double from, double to) {
          const double x_m = from + share * (to - from);
          return std::abs(x_m) < kRounding * grid_.resolution_m ? 0.0 : x_m;
        };
        return Point{between(motion.from.x_m, motion.to.x_m), between(motion.from.y_m, motion.to.y_m)};
      };
      const RouteVertex vertex = looked(at((shares[i] + shares[i - 1]) / 2), at(shares[i - 1]), heading);
      const bool first = emitted < 0.0;
      if (first) leaveOutNear(vertex);
      if (first && represents(motion)) {
        moveTo(vertices.back(), vertex);
        emitted = 0.0;
      } else if (first || ((shares[i - 1] - emitted) * length_m >= kTogether * grid_.resolution_m &&
                           metres >= kTogether * grid_.resolution_m)) {
        vertices.push_back(vertex);
        emitted = std::max(shares[i - 1], 0.0);
        if (first) turns_ = vertices.size();
      }
      spend(vertex, metres);
    }
    length_m_ += length_m;
  }

  // A turn in place, or the change of heading along an arc.
  void turn(double turn_rad, Point place) {
    const auto cell = grid_.cellAt(place);
    const TurnEfforts& prices =
        cell ? input_.kinematics.turnsOn(input_.map.at(*cell).curve()) : input_.kinematics.turns;
    const bool in_place = how_.curvature_1_m == 0.0;
    spend(in_place ? prices.in_place : prices.on_arc, std::abs(turn_rad));
  }

  // Adds the vertex at which the rover stops and turns in place.
  void stand(const Pose& pose, double turn_rad) {
    how_ = {};
    RouteVertex vertex =
        looked(pose.place, pose.place, {std::cos(pose.heading_rad), std::sin(pose.heading_rad)});
    vertex.turn_rad = turn_rad;
    leaveOutNear(vertex);
    vertices.push_back(vertex);
    turns_ = vertices.size();
    spend(input_.kinematics.stop, 1.0);
    turn(turn_rad, pose.place);
  }

  // Adds the turn between two legs of a polyline.
  void vertex(Point at, Direction from, Direction to) {
    const auto cell = grid_.cellAt(at);
    if (!cell) return;
    spend(input_.map.cost().turn(input_.map.at(*cell)), std::abs(turnBetween_rad(from, to)));
  }

  void cusp() { spend(input_.kinematics.cusp, 1.0); }

  void arrive(Point end) {
    if (how_.heading && vertices.size() > 1 && isLeast(vertices.back(), end) &&
        maySkip(vertices[vertices.size() - 2], vertices.back(), end)) {
      vertices.pop_back();
      turns_ = std::min(turns_, vertices.size());
    }
    RouteVertex last = vertices.empty() ? looked(end, end, {1.0, 0.0}) : vertices.back();
    last.x_m = end.x_m;
    last.y_m = end.y_m;
    last.elevation_m = elevation(end);
    count(last);
    leaveOutNear(last);
    vertices.push_back(last);
  }

  RouteSummary summary() const {
    RouteSummary made;
    made.energy_J = energy_J_;
    made.time_s = time_s_;
    made.length_m = length_m_;
    made.max_slip = std::isnan(time_s_) ? kNotKnown : max_slip_;  // a stated cost has no slip
    made.max_slope_rad = max_slope_rad_;
    made.max_slope_across_rad = max_slope_across_rad_;
    made.max_slip_angle_rad = max_slip_angle_rad_;
    return made;
  }

  std::vector<RouteVertex> vertices;
  TurnEffort turns;  // energy and time of all turns and stops

 private:
  // Vertex at `at` with the properties of the cell that contains `inside`, for the heading.
  RouteVertex looked(Point inside, Point at, Direction heading) {
    RouteVertex vertex;
    vertex.x_m = at.x_m;
    vertex.y_m = at.y_m;
    vertex.elevation_m = elevation(at);
    const double side = how_.reverse ? -1.0 : 1.0;
    vertex.heading_rad = std::atan2(side * heading.y, side * heading.x);
    vertex.reverse = how_.reverse;
    vertex.curvature_1_m = how_.curvature_1_m;
    state_ = {};
    if (const auto cell = grid_.cellAt(inside)) {
      const auto code = input_.map.at(*cell);
      state_ = input_.map.cost().detail(code, heading);
      const terramech::Gradient slope = gradientOf(code, heading);
      vertex.slope_along_rad = std::atan(slope.along);
      vertex.slope_across_rad = std::atan(slope.across);
      vertex.slip = static_cast<double>(state_.slip);
      const auto angle_rad = static_cast<double>(state_.slip_angle_rad);
      vertex.slip_angle_rad = how_.reverse ? -angle_rad : angle_rad;
      vertex.side_force_over_load = static_cast<double>(state_.side_force_over_load);
      vertex.stability_margin_rad = static_cast<double>(state_.stability_margin_rad);
      vertex.sinkage_m = static_cast<double>(state_.sinkage_m);
      vertex.torque_Nm = static_cast<double>(state_.torque_Nm);
      vertex.drawbar_pull_margin = static_cast<double>(state_.pull_margin);
      vertex.category = state_.category;
      vertex.hazard_per_m = std::isinf(state_.risk_per_m) ? 0.0 : static_cast<double>(state_.risk_per_m);
      vertex.soil_class = state_.class_index;
      const auto& shared = input_.map.cost().uncertainty().shared;
      vertex.shared_variance_share = state_.class_index < shared.size() ? shared[state_.class_index] : 0.0;
    }
    count(vertex);
    return vertex;
  }

  bool isLeast(const RouteVertex& from, Point to) const {
    return from.turn_rad == 0.0 &&
           std::hypot(to.x_m - from.x_m, to.y_m - from.y_m) < kTogether * grid_.resolution_m;
  }

  // Returns true if the rover may drive straight from vertex `from` past `passed`, reached and left in the
  // same direction.
  bool maySkip(const RouteVertex& from, const RouteVertex& passed, Point to) const {
    return from.turn_rad == 0.0 && from.reverse == passed.reverse &&
           std::isfinite(cost_({{from.x_m, from.y_m}, to}));
  }

  // Returns true if the last vertex, a chord too short to determine a heading, may represent the following
  // motion.
  bool represents(const Segment& motion) const {
    return how_.heading && turns_ > 0 && turns_ == vertices.size() && isLeast(vertices.back(), motion.from) &&
           vertices.back().reverse == how_.reverse &&
           std::isfinite(cost_({{vertices.back().x_m, vertices.back().y_m}, motion.to}));
  }

  // Assigns the properties of `next` to `vertex`; position and accumulated quantities of `vertex` are kept.
  static void moveTo(RouteVertex& vertex, RouteVertex next) {
    next.x_m = vertex.x_m;
    next.y_m = vertex.y_m;
    next.elevation_m = vertex.elevation_m;
    next.energy_J = vertex.energy_J;
    next.time_s = vertex.time_s;
    next.immobilisation_risk = vertex.immobilisation_risk;
    vertex = next;
  }

  // Removes vertices close to the new one, except turns: a turn replaces a nearby entry into another cell.
  void leaveOutNear(const RouteVertex& vertex) {
    const auto near = [&](const RouteVertex& other) {
      return std::hypot(vertex.x_m - other.x_m, vertex.y_m - other.y_m) < kTogether * grid_.resolution_m;
    };
    while (vertices.size() > turns_ && near(vertices.back())) vertices.pop_back();
  }

  void count(RouteVertex& vertex) const {
    vertex.energy_J = energy_J_;
    vertex.time_s = time_s_;
    vertex.immobilisation_risk = -std::expm1(-hazard_);
  }

  void spend(const RouteVertex& vertex, double metres) {
    const auto finite = [](float value) { return std::isinf(value) ? 0.0 : static_cast<double>(value); };
    energy_J_ += finite(state_.energy_J_per_m) * metres;
    time_s_ += finite(state_.time_s_per_m) * metres;
    hazard_ += finite(state_.risk_per_m) * metres;
    max_slip_ = std::fmax(max_slip_, std::abs(vertex.slip));
    max_slope_rad_ = std::fmax(max_slope_rad_, std::abs(vertex.slope_along_rad));
    max_slope_across_rad_ = std::fmax(max_slope_across_rad_, std::abs(vertex.slope_across_rad));
    max_slip_angle_rad_ = std::fmax(max_slip_angle_rad_, std::abs(vertex.slip_angle_rad));
  }

  void spend(const TurnEffort& price, double times) {
    energy_J_ += price.energy_J * times;
    time_s_ += price.time_s * times;
    turns.energy_J += price.energy_J * times;
    turns.time_s += price.time_s * times;
  }

  double elevation(Point p) const {
    return (input_.elevation_m ? input_.elevation_m(p) : input_.map.elevation_m(p)).value_or(kNotKnown);
  }

  const AnnotationInput& input_;
  const maps::Grid& grid_;
  MotionCost cost_;
  std::size_t turns_ = 0;  // number of vertices up to the last turn or the beginning
  Motion how_;
  costmap::TravelState state_;  // of the cell of the latest looked()
  double energy_J_ = 0.0, time_s_ = 0.0, hazard_ = 0.0, length_m_ = 0.0, max_slip_ = 0.0,
         max_slope_rad_ = 0.0, max_slope_across_rad_ = 0.0, max_slip_angle_rad_ = 0.0;
};

void driveAlong(const PosePath& drive, const costmap::CostGrid& map, Annotator& annotator) {
  Pose pose = drive.start;
  int last = 0;
  for (const PosePath::Leg& leg : drive.legs) {
    const int now = direction(leg);
    if (now * last < 0) annotator.cusp();
    if (now != 0) last = now;
    if (leg.turn_rad != 0.0) annotator.stand(pose, leg.turn_rad);
    const auto poses = chords({.start = pose, .legs = {leg}}, map);
    for (std::size_t i = 1; i < poses.size() && leg.turn_rad == 0.0; ++i) {
      const double middle_rad = 0.5 * (poses[i - 1].heading_rad + poses[i].heading_rad);
      annotator.drive({poses[i - 1].place, poses[i].place},
                      {.reverse = now < 0,
                       .curvature_1_m = leg.arc.curvature_1_m,
                       .heading = Direction{now * std::cos(middle_rad), now * std::sin(middle_rad)}});
      if (leg.arc.curvature_1_m != 0.0)
        annotator.turn(poses[i].heading_rad - poses[i - 1].heading_rad, poses[i - 1].place);
    }
    pose = poses.back();
  }
}

void polylineAlong(const Polyline& points, Annotator& annotator) {
  std::optional<Direction> before;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Segment leg{points[i - 1], points[i]};
    if (leg.from == leg.to) continue;
    const Direction heading = directionOf(leg);
    if (before) annotator.vertex(leg.from, *before, heading);
    annotator.drive(leg);
    before = heading;
  }
}

}  // namespace

namespace {

// Replaces the additive risk of the vertices by the simulated risk if the cost has a correlation length of
// the soil.
void setRisk(Route& route, const costmap::CostGrid& map, const ProgressMonitor& watch) {
  constexpr int kWorlds = 400;  // standard error of the risk about 10 %
  if (!(map.cost().uncertainty().correlation_length_m > 0.0)) return;
  RouteRiskOptions options = riskOptions(map);
  options.worlds = kWorlds;
  std::vector<double> risk = riskAlong(route, options, watch);
  if (risk.empty()) {
    risk = riskBoundAlong(route, options);
    route.interrupted = true;
  }
  for (std::size_t i = 0; i < risk.size(); ++i) route.vertices[i].immobilisation_risk = risk[i];
}

// Replaces energy and time by those of the drives that arrive, those of vertices in proportion. Turns are certain.
void setForecast(Route& route, const costmap::CostGrid& map, const TurnEffort& turns) {
  const RouteForecast drive = routeForecast(route, map, riskOptions(map));
  const auto set = [&](double RouteVertex::*of, double& total, double certain, const DriveEffort& effort) {
    const double ratio = total > 0.0 && effort.mean > 0.0 ? (effort.mean + certain) / total : 1.0;
    for (RouteVertex& vertex : route.vertices) vertex.*of *= ratio;
    total *= ratio;
    return std::isnan(total) ? total : std::max(effort.p90 + certain, total);
  };
  RouteSummary& made = route;
  made.energy_p90_J = set(&RouteVertex::energy_J, made.energy_J, turns.energy_J, drive.energy_J);
  made.time_p90_s = set(&RouteVertex::time_s, made.time_s, turns.time_s, drive.time_s);
}

std::string text(maps::Point point) {
  std::array<char, 64> place{};
  std::snprintf(place.data(), place.size(), "%.2f,%.2f", point.x_m, point.y_m);
  return place.data();
}

std::string refusalText(const Violation& violation, const std::string& planner) {
  return "no route: the check refuses the one that '" + planner + "' found at " + text(violation.place) +
         ": " + violation.reason + "; please report it";
}

// Reason and remedy for an end at which a wheel would stand on ground to avoid.
std::string endText(const Violation& violation, const costmap::CostGrid& map) {
  const auto& outline = map.cost().limits().outline;
  std::array<char, 32> reach{};
  std::snprintf(reach.data(), reach.size(), "%.2f", 0.5 * std::hypot(outline.wheelbase_m, outline.track_m));
  return "no route: " + violation.reason + " at the end " + text(violation.place) +
         " of the route found; choose a place more than " + reach.data() +
         " m away from such ground and from the border";
}

}  // namespace

double gapOf(double cost, double lower_bound) noexcept {
  if (lower_bound > 0.0) return cost / lower_bound - 1.0;
  return cost > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

Route annotated(const Plan& plan, const AnnotationInput& input) {
  Route route;
  route.status = plan.status;
  route.reason = plan.reason;
  route.obstruction = plan.obstruction;
  route.interrupted = plan.interrupted;
  route.goal = plan.goal;
  route.planner = input.planner;
  if (plan.points.empty()) return route;
  Annotator annotator(input);
  driveAlong(plan.drive, input.map, annotator);
  if (plan.drive.legs.empty()) polylineAlong(plan.points, annotator);
  annotator.arrive(plan.points.back());
  static_cast<RouteSummary&>(route) = annotator.summary();
  route.planner = input.planner;
  if (!plan.drive.legs.empty()) route.drive = shape(plan.drive);
  route.cost = plan.cost_J;
  route.lower_bound = plan.lower_bound_J;
  route.gap = gapOf(plan.cost_J, plan.lower_bound_J);
  route.proof_s = plan.proof_s;
  route.vertices = std::move(annotator.vertices);
  setForecast(route, input.map, annotator.turns);
  setRisk(route, input.map, input.watch);
  return route;
}

Route checkedRoute(const Plan& plan, const AnnotationInput& input) {
  Route route = annotated(plan, input);
  if (plan.status != RouteStatus::Found) return route;
  const bool drives = !plan.drive.legs.empty();
  auto found = drives ? violationsOfChords(input.map, plan.points) : violations(input.map, plan.points);
  if (found.empty() && drives) found = violations(input.map, plan.drive, input.kinematics.turning_radius_m);
  Route none;
  none.planner = input.planner;
  if (!found.empty()) {
    none.reason = refusalText(found.front(), input.planner);
  } else {
    const auto at_ends =
        violationsAtEnds(input.map, drives ? endPoses(plan.drive) : endPoses(plan.points), input.hazards);
    if (at_ends.empty()) return route;
    none.reason = endText(at_ends.front(), input.map);
  }
  none.refused = std::make_shared<const Route>(std::move(route));
  return none;
}

}  // namespace talus::planner
