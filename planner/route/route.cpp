#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/terramech/contact/load_transfer.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::planner {

namespace {

// Wraps an angle to [0, 2 pi); values less than 1e-9 below a full turn are rounding and become 0.
double turned(double angle) noexcept {
  const double full = 2.0 * std::numbers::pi;
  const double rest = angle - full * std::floor(angle / full);
  return full - rest < 1e-9 ? 0.0 : rest;
}

// A path of three pieces: lengths in radii; sides +1 left, 0 straight, -1 right.
struct Word {
  std::array<double, 3> length{};
  std::array<int, 3> side{};
  double total() const noexcept { return length[0] + length[1] + length[2]; }
};

// Start at the origin with heading `alpha`, end at (d, 0) with heading `beta`, both relative to the
// connecting line.
struct Ends {
  double d, alpha, beta;
  double sin_alpha = std::sin(alpha), cos_alpha = std::cos(alpha);
  double sin_beta = std::sin(beta), cos_beta = std::cos(beta);
};

// Turn, straight, turn. (along, across) is the vector between the centres of both circles. The straight piece
// has the same length (outer tangent) or is the other leg to 2 radii (inner tangent).
Word turnStraightTurn(const Ends& e, int first, int last) noexcept {
  Word none{.length = {std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const double along = e.d - last * e.sin_beta + first * e.sin_alpha;
  const double across = last * e.cos_beta - first * e.cos_alpha;
  const double square = along * along + across * across;
  double straight = std::sqrt(square), heading = std::atan2(across, along);
  if (first != last) {
    if (square < 4.0) return none;
    straight = std::sqrt(square - 4.0);
    heading += first * std::atan2(2.0, straight);
  }
  return {.length = {turned(first * (heading - e.alpha)), straight, turned(last * (e.beta - heading))},
          .side = {first, 0, last}};
}

// Turn, turn the other way by more than half a circle, turn the first way.
Word threeTurns(const Ends& e, int side) noexcept {
  Word none{.length = {std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const double along = e.d - side * e.sin_beta + side * e.sin_alpha;
  const double across = side * e.cos_beta - side * e.cos_alpha;
  const double apart = std::hypot(along, across);
  if (apart > 4.0) return none;
  // Centre of the middle circle, which touches both others, on the side for which the middle turn exceeds
  // half a circle.
  const double corner = side * std::acos(apart / 4.0), heading = std::atan2(across, along);
  const double to_middle = heading + corner, from_last = heading + std::numbers::pi - corner;
  const double first = turned(side * (to_middle - e.alpha) + std::numbers::pi / 2);
  const double middle = turned(side * (to_middle - from_last));
  const double last = turned(side * (e.beta - from_last) - std::numbers::pi / 2);
  return {.length = {first, middle, last}, .side = {side, -side, side}};
}

namespace ob = ompl::base;

constexpr double kStop_s = 20.0;  // ours, not from the literature

void set(ob::State* state, const Pose& pose) {
  auto* se2 = state->as<ob::SE2StateSpace::StateType>();
  se2->setXY(pose.place.x_m, pose.place.y_m);
  se2->setYaw(std::remainder(pose.heading_rad, 2.0 * std::numbers::pi));
}

// Both ends as states of a space; freed by the destructor.
struct States {
  States(const ob::StateSpace& of, const std::pair<Pose, Pose>& ends)
      : space(of), from(of.allocState()), to(of.allocState()) {
    set(from, ends.first);
    set(to, ends.second);
  }
  ~States() {
    space.freeState(from);
    space.freeState(to);
  }
  States(const States&) = delete;
  States& operator=(const States&) = delete;

  const ob::StateSpace& space;
  ob::State* from;
  ob::State* to;
};

// Appends a segment of signed length in radii; `side` is +1 left, 0 straight, -1 right.
void append(std::vector<Arc>& arcs, double length, int side, double radius_m) {
  if (std::abs(length) > 1e-12) arcs.push_back({length * radius_m, side / radius_m});
}

std::vector<Arc> reedsShepp(const ob::ReedsSheppStateSpace& space, const std::pair<Pose, Pose>& ends,
                            double radius_m) {
  using Space = ob::ReedsSheppStateSpace;
  const States states(space, ends);
  const auto path = space.reedsShepp(states.from, states.to);
  std::vector<Arc> arcs;
  for (int k = 0; k < 5 && path.type_[k] != Space::RS_NOP; ++k) {
    const int side = path.type_[k] == Space::RS_LEFT ? 1 : path.type_[k] == Space::RS_RIGHT ? -1 : 0;
    append(arcs, path.length_[k], side, radius_m);
  }
  return arcs;
}

}  // namespace

std::vector<Arc> shortestForward(const Pose& from, const Pose& to, double radius_m) {
  const double dx = to.place.x_m - from.place.x_m, dy = to.place.y_m - from.place.y_m;
  const double line = std::atan2(dy, dx);
  const Ends ends{std::hypot(dx, dy) / radius_m, from.heading_rad - line, to.heading_rad - line};
  Word best = turnStraightTurn(ends, 1, 1);
  for (const Word& word : {turnStraightTurn(ends, -1, -1), turnStraightTurn(ends, 1, -1),
                           turnStraightTurn(ends, -1, 1), threeTurns(ends, 1), threeTurns(ends, -1)})
    if (word.total() < best.total()) best = word;
  std::vector<Arc> arcs;
  for (std::size_t k = 0; k < 3; ++k)
    if (best.length[k] > 1e-12) arcs.push_back({best.length[k] * radius_m, best.side[k] / radius_m});
  return arcs;
}

struct ShortestCurves::Spaces {
  explicit Spaces(double radius_m) : reeds_shepp(radius_m) {}
  ob::ReedsSheppStateSpace reeds_shepp;
};

ShortestCurves::ShortestCurves(const Kinematics& kinematics)
    : radius_m_(kinematics.turning_radius_m), may_reverse_(kinematics.may_reverse) {
  terramech::RangeCheck("kinematics")
      .within("turning_radius_m", radius_m_, {terramech::kSmallestTurn_m, terramech::kLargestTurn_m});
  spaces_ = std::make_unique<const Spaces>(radius_m_);
}
ShortestCurves::~ShortestCurves() = default;
ShortestCurves::ShortestCurves(ShortestCurves&&) noexcept = default;

std::vector<Arc> ShortestCurves::operator()(const Pose& from, const Pose& to) const {
  return may_reverse_ ? reedsShepp(spaces_->reeds_shepp, {from, to}, radius_m_) : forward(from, to);
}

std::vector<Arc> ShortestCurves::forward(const Pose& from, const Pose& to) const {
  return shortestForward(from, to, radius_m_);
}

Pose after(const Pose& from, const Arc& arc) noexcept {
  const double turn = arc.length_m * arc.curvature_1_m;
  // Chord of the arc: length * sinc(turn / 2), at the mean heading.
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-9 ? arc.length_m : arc.length_m * std::sin(half) / half;
  const double mean = from.heading_rad + half;
  return {{from.place.x_m + chord * std::cos(mean), from.place.y_m + chord * std::sin(mean)},
          from.heading_rad + turn};
}

Kinematics kinematicsOn(const costmap::GroundModel& model, const costmap::TravelCost& cost) {
  const terramech::Rover& rover = model.rover();
  if (rover.steering == terramech::Steering::Ackermann && rover.turning_radius_m <= 0.0)
    throw std::invalid_argument(
        "rover '" + rover.name +
        "': turning_radius_m = 0, must be > 0 with steering ackermann; state it in the rover's file");
  const auto lasting = [&](double time_s) { return TurnEffort{rover.hotel_power_W * time_s, time_s}; };
  return {.turning_radius_m = rover.turning_radius_m,
          .turns_by_curve = cost.turns(),
          .cusp = lasting(rover.wheel.radius_m / rover.max_speed_mps),
          .stop = lasting(kStop_s)};
}

std::string_view name(RouteStatus status) noexcept {
  switch (status) {
    case RouteStatus::Found:
      return "found";
    case RouteStatus::NoRoute:
      return "no_route";
    case RouteStatus::NoneFound:
      return "none_found";
    case RouteStatus::StartInvalid:
      return "start_invalid";
    case RouteStatus::GoalInvalid:
      return "goal_invalid";
    case RouteStatus::TimedOut:
      return "timed_out";
    case RouteStatus::Cancelled:
      return "cancelled";
  }
  return "unknown";
}

const char* name(Constraint constraint) noexcept {
  switch (constraint) {
    case Constraint::Pitch:
      return "pitch";
    case Constraint::Roll:
      return "roll";
    case Constraint::Soil:
      return "soil";
    case Constraint::Hazard:
      return "hazard";
    case Constraint::Unknown:
      return "unknown";
    case Constraint::Rim:
      return "rim";
    case Constraint::Slope:
      return "slope";
  }
  return "";
}

const char* name(costmap::Hazard hazard) noexcept {
  using costmap::Hazard;
  if (hazard == Hazard::KeepOut) return "keep_out";
  if (hazard == Hazard::Obstacle) return "impassable_class";
  if (hazard == Hazard::Rocks) return "rocks";
  if (hazard == Hazard::Step) return "step";
  return hazard == Hazard::Roughness ? "roughness" : "";
}

}  // namespace talus::planner
