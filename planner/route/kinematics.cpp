#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <talus/costmap/cost/turn_price.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/route/dubins.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/turning_radius.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::planner {
namespace {

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
  const auto lasting = [&](double time_s) {
    return costmap::priced(terramech::TurnEffort{rover.hotel_power_W * time_s, time_s}, 1.0,
                           model.parts().policy.time_weight_W);
  };
  return {.turning_radius_m = rover.turning_radius_m,
          .turns_by_curve = cost.turns(),
          .cusp = lasting(rover.wheel.radius_m / rover.max_speed_mps),
          .stop = lasting(kStop_s)};
}

}  // namespace talus::planner
