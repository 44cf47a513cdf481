#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {
namespace {

constexpr double kChord_cells = 0.5;
constexpr double kBend_rad = 0.1;  // the distance of a chord from its arc is at most 0.1^2/8 of the radius

int chordsOf(const Arc& arc, double step_m) noexcept {
  const double bend = std::abs(arc.length_m * arc.curvature_1_m) / kBend_rad;
  return std::max(1, static_cast<int>(std::ceil(std::max(std::abs(arc.length_m) / step_m, bend) - 1e-9)));
}

std::vector<PosePath::Leg> turnDriveTurn(const Pose& from, const Pose& to, bool may_reverse) {
  const double dx = to.place.x_m - from.place.x_m, dy = to.place.y_m - from.place.y_m;
  const double length = std::hypot(dx, dy);
  const double ahead = length > 0.0 ? std::atan2(dy, dx) : to.heading_rad;
  const auto turns = [&](double drive) {
    return std::pair{std::remainder(drive - from.heading_rad, 2.0 * std::numbers::pi),
                     std::remainder(to.heading_rad - drive, 2.0 * std::numbers::pi)};
  };
  auto [first, last] = turns(ahead);
  double signed_length = length;
  if (const auto [f, l] = turns(ahead + std::numbers::pi);
      may_reverse && std::abs(f) + std::abs(l) < std::abs(first) + std::abs(last)) {
    first = f, last = l;
    signed_length = -length;
  }
  std::vector<PosePath::Leg> legs;
  if (std::abs(first) > 1e-9) legs.push_back({{}, first});
  if (length > 0.0) legs.push_back({{signed_length, 0.0}, 0.0});
  if (std::abs(last) > 1e-9) legs.push_back({{}, last});
  return legs;
}

}  // namespace

Pose after(const Pose& from, const PosePath::Leg& leg) noexcept {
  Pose pose = after(from, leg.arc);
  pose.heading_rad += leg.turn_rad;
  return pose;
}

int direction(const PosePath::Leg& leg) noexcept {
  return (leg.arc.length_m > 0.0) - (leg.arc.length_m < 0.0);
}

PoseCost::PoseCost(const MotionCost& cost, const Kinematics& kinematics)
    : cost_(cost), kinematics_(kinematics), step_m_(kChord_cells * cost.map().grid().resolution_m) {
  if (kinematics.turning_radius_m > 0.0) curves_.emplace(kinematics);
}

std::vector<PosePath::Leg> PoseCost::direct(const Pose& from, const Pose& to, bool forward) const {
  if (!curves_) return turnDriveTurn(from, to, kinematics_.may_reverse && !forward);
  std::vector<PosePath::Leg> legs;
  for (const Arc& arc : forward ? curves_->forward(from, to) : (*curves_)(from, to))
    legs.push_back({arc, 0.0});
  return legs;
}

const TurnCosts& PoseCost::turnsAt(maps::Point place) const noexcept {
  const auto cell = cost_.map().grid().cellAt(place);
  return cell ? kinematics_.turnsOn(cost_.map().at(*cell).curve()) : kinematics_.turns;
}

double PoseCost::operator()(const Pose& from, const PosePath::Leg& leg) const noexcept {
  return leg.turn_rad != 0.0 ? turnInPlace(from, leg.turn_rad) : arc(from, leg.arc);
}

double PoseCost::arc(const Pose& from, const Arc& arc) const noexcept {
  const int count = arc.curvature_1_m == 0.0 ? 1 : chordsOf(arc, step_m_);
  const Arc part{arc.length_m / count, arc.curvature_1_m};
  const double turn_rad = std::abs(part.length_m * part.curvature_1_m);
  double sum = 0.0;
  Pose pose = from;
  for (int k = 0; k < count; ++k) {
    const Pose next = after(pose, part);
    sum += cost_({pose.place, next.place});
    if (sum == kInfinity) return kInfinity;
    if (turn_rad > 0.0) sum += turnsAt(pose.place).on_arc.cost_J * turn_rad;
    pose = next;
  }
  return sum;
}

// Accumulated rounding may move a place to either side of an edge, so that a turn there needs both cells.
double PoseCost::turnInPlace(const Pose& from, double turn_rad) const noexcept {
  if (!cost_.map().grid().cellAt(from.place)) return kInfinity;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / kBend_rad)));
  for (int k = 0; k <= steps; ++k) {
    const double heading = from.heading_rad + turn_rad * k / steps;
    if (!cost_.headingAllowed(from.place, {std::cos(heading), std::sin(heading)})) return kInfinity;
  }
  return kinematics_.stop.cost_J + turnsAt(from.place).in_place.cost_J * std::abs(turn_rad);
}

double PoseCost::operator()(const PosePath& path) const noexcept {
  double sum = 0.0;
  Pose pose = path.start;
  int last = 0;
  for (const auto& leg : path.legs) {
    const int now = direction(leg);
    if (now * last < 0) sum += kinematics_.cusp.cost_J;
    if (now != 0) last = now;
    sum += (*this)(pose, leg);
    pose = after(pose, leg);
  }
  return sum;
}

std::vector<Pose> sampled(const PosePath& path, double step_m) {
  std::vector<Pose> poses{path.start};
  for (const auto& leg : path.legs) {
    const int count = leg.turn_rad != 0.0 ? 1 : chordsOf(leg.arc, step_m);
    const PosePath::Leg part{{leg.arc.length_m / count, leg.arc.curvature_1_m}, leg.turn_rad};
    for (int k = 0; k < count; ++k) poses.push_back(after(poses.back(), part));
  }
  return poses;
}

std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map) {
  std::vector<Pose> poses{path.start};
  for (const auto& leg : path.legs) {
    const bool whole = leg.turn_rad != 0.0 || leg.arc.curvature_1_m == 0.0;
    const int count = whole ? 1 : chordsOf(leg.arc, kChord_cells * map.grid().resolution_m);
    const PosePath::Leg part{{leg.arc.length_m / count, leg.arc.curvature_1_m}, leg.turn_rad};
    for (int k = 0; k < count; ++k) poses.push_back(after(poses.back(), part));
  }
  return poses;
}

RouteShape shape(const PosePath& path) noexcept {
  RouteShape shape;
  int last = 0;
  for (const auto& leg : path.legs) {
    const int now = direction(leg);
    if (now * last < 0) ++shape.cusps;
    if (now != 0) last = now;
    shape.turned_rad += std::abs(leg.arc.length_m * leg.arc.curvature_1_m) + std::abs(leg.turn_rad);
    shape.max_curvature_1_m = std::max(shape.max_curvature_1_m, std::abs(leg.arc.curvature_1_m));
    if (leg.turn_rad != 0.0) ++shape.turns_in_place;
  }
  return shape;
}

double length_m(const PosePath& path) noexcept {
  double sum = 0.0;
  for (const auto& leg : path.legs) sum += std::abs(leg.arc.length_m);
  return sum;
}

}  // namespace talus::planner
