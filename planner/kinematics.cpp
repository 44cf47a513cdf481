#include <cmath>
#include <stdexcept>

#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/DubinsStateSpace.h>
#include <ompl/base/spaces/ReedsSheppStateSpace.h>

#include <planner/kinematics.hpp>

namespace talus::planner {
namespace {

namespace ob = ompl::base;

// Sum over the wheels of load times distance from the middle along the heading [N m].
double scrubLever_Nm(const terramech::Rover& rover) {
  const int axles = std::max(1, rover.wheel_count / 2);
  double lever = 0.0;
  for (int k = 0; k < axles; ++k) {
    const double x = axles == 1 ? 0.0 : rover.wheelbase_m * (static_cast<double>(k) / (axles - 1) - 0.5);
    lever += 2.0 * terramech::wheelLoad_N(rover) * std::abs(x);
  }
  return lever;
}

void set(ob::State* state, const Pose& pose) {
  auto* se2 = state->as<ob::SE2StateSpace::StateType>();
  se2->setXY(pose.place.x_m, pose.place.y_m);
  se2->setYaw(std::remainder(pose.heading_rad, 2.0 * M_PI));
}

// Segments in units of the radius, signed; `side` is +1 left, 0 straight, -1 right.
void append(std::vector<Arc>& arcs, double length, int side, double radius_m) {
  if (std::abs(length) > 1e-12) arcs.push_back({length * radius_m, side / radius_m});
}

std::vector<Arc> reedsShepp(const Pose& from, const Pose& to, double radius_m) {
  using Space = ob::ReedsSheppStateSpace;
  const auto space = std::make_shared<Space>(radius_m);
  ob::ScopedState<Space> a(space), b(space);
  set(a.get(), from);
  set(b.get(), to);
  const auto path = space->reedsShepp(a.get(), b.get());
  std::vector<Arc> arcs;
  for (int k = 0; k < 5 && path.type_[k] != Space::RS_NOP; ++k) {
    const int side = path.type_[k] == Space::RS_LEFT ? 1 : path.type_[k] == Space::RS_RIGHT ? -1 : 0;
    append(arcs, path.length_[k], side, radius_m);
  }
  return arcs;
}

std::vector<Arc> dubins(const Pose& from, const Pose& to, double radius_m) {
  using Space = ob::DubinsStateSpace;
  const auto space = std::make_shared<Space>(radius_m);
  ob::ScopedState<Space> a(space), b(space);
  set(a.get(), from);
  set(b.get(), to);
  const auto path = space->dubins(a.get(), b.get());
  std::vector<Arc> arcs;
  for (int k = 0; k < 3; ++k) {
    const int side = path.type_[k] == Space::DUBINS_LEFT ? 1 : path.type_[k] == Space::DUBINS_RIGHT ? -1 : 0;
    append(arcs, path.length_[k], side, radius_m);
  }
  return arcs;
}

}  // namespace

Kinematics kinematicsOf(const terramech::Rover& rover, const TurningGround& ground) {
  if (rover.steering == terramech::Steering::Ackermann && rover.turning_radius_m <= 0.0)
    throw std::invalid_argument("rover '" + rover.name +
                                "': turning_radius_m = 0, must be > 0 with steering ackermann");
  const bool skids = rover.steering == terramech::Steering::Skid;
  const double rho = 0.5 * std::hypot(rover.wheelbase_m, rover.track_m);
  return {.turning_radius_m = rover.turning_radius_m,
          .turn_cost_J_per_rad =
              skids ? ground.lateral_resistance * scrubLever_Nm(rover) : ground.rolling_J_per_m * rho};
}

Pose after(const Pose& from, const Arc& arc) noexcept {
  const double turn = arc.length_m * arc.curvature_1_m;
  // Chord of the arc: length times sinc(turn / 2), at the mean heading.
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-9 ? arc.length_m : arc.length_m * std::sin(half) / half;
  const double mean = from.heading_rad + half;
  return {{from.place.x_m + chord * std::cos(mean), from.place.y_m + chord * std::sin(mean)},
          from.heading_rad + turn};
}

std::vector<Arc> shortestArcs(const Pose& from, const Pose& to, const Kinematics& kinematics) {
  if (!(kinematics.turning_radius_m > 0.0))
    throw std::invalid_argument(
        "kinematics: turning_radius_m = " + std::to_string(kinematics.turning_radius_m) +
        ", must be > 0 for a shortest curve");
  return kinematics.may_reverse ? reedsShepp(from, to, kinematics.turning_radius_m)
                                : dubins(from, to, kinematics.turning_radius_m);
}

}  // namespace talus::planner
