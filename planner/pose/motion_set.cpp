#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/common/constants.hpp>
#include <talus/planner/pose/motion_set.hpp>

namespace talus::planner {
namespace {

constexpr double kStretch_cells = 0.5;  // longest stretch priced by a single cell

}  // namespace

MotionSet::MotionSet(const costmap::CostGrid& map, const Kinematics& kinematics, const Options& options)
    : map_(map),
      kinematics_(kinematics),
      options_(options),
      bin_rad_(2.0 * std::numbers::pi / options.headings),
      inverse_resolution_(1.0 / map.grid().resolution_m),
      motions_(static_cast<std::size_t>(options.headings)) {
  const auto all = legs();
  for (int k = 0; k < options.headings; ++k)
    for (const PosePath::Leg& leg : all) {
      const double turn = leg.turn_rad + leg.arc.length_m * leg.arc.curvature_1_m;
      const int turned = static_cast<int>(std::lround(turn / bin_rad_));
      const int heading = ((k + turned) % options.headings + options.headings) % options.headings;
      motions_[static_cast<std::size_t>(k)].push_back(made(leg, k, heading));
    }
}

// Legs from heading number 0; every change of heading is an integer number of bins.
std::vector<PosePath::Leg> MotionSet::legs() const {
  const double step_m = options_.step_cells * map_.grid().resolution_m;
  const double radius_m = kinematics_.turning_radius_m;
  std::vector<PosePath::Leg> legs{{{step_m, 0.0}, 0.0}};
  if (radius_m > 0.0)
    for (const double curvature : {1.0 / radius_m, 1.0 / (3.0 * radius_m)}) {
      const double bins = std::clamp(std::round(step_m * curvature / bin_rad_), 1.0, options_.headings / 4.0);
      for (const double side : {1.0, -1.0})
        legs.push_back({{bins * bin_rad_ / curvature, side * curvature}, 0.0});
    }
  if (kinematics_.may_reverse)
    for (std::size_t k = 0, count = legs.size(); k < count; ++k) {
      legs.push_back(legs[k]);
      legs.back().arc.length_m *= -1.0;
    }
  if (radius_m <= 0.0)
    for (const int bins : {1, 3, 9})
      for (const double side : {1.0, -1.0}) legs.push_back({{}, side * bins * bin_rad_});
  return legs;
}

MotionSet::Motion MotionSet::made(const PosePath::Leg& leg, int heading, int turned) const {
  const Pose from{{0.0, 0.0}, heading_rad(heading)};
  const Pose end = after(from, leg);
  Motion motion{.leg = leg,
                .dx_m = end.place.x_m,
                .dy_m = end.place.y_m,
                .heading = turned,
                .direction = direction(leg),
                .turn_rad = std::abs(leg.turn_rad) + std::abs(leg.arc.length_m * leg.arc.curvature_1_m)};
  const int count =
      static_cast<int>(std::ceil(std::abs(leg.arc.length_m) * inverse_resolution_ / kStretch_cells - 1e-9));
  for (int k = 0; k < count; ++k) {
    const Pose middle = after(from, Arc{leg.arc.length_m * (k + 0.5) / count, leg.arc.curvature_1_m});
    const costmap::Direction way{motion.direction * std::cos(middle.heading_rad),
                                 motion.direction * std::sin(middle.heading_rad)};
    motion.stretches.push_back({.dx_m = middle.place.x_m,
                                .dy_m = middle.place.y_m,
                                .length_m = std::abs(leg.arc.length_m) / count,
                                .cost = HeadingCost(map_.cost(), way)});
  }
  return motion;
}

std::uint64_t MotionSet::work() const noexcept {
  constexpr std::uint64_t kUsual = 80;  // number of stretches for a radius of five cells
  std::uint64_t stretches = 0;
  for (const Motion& motion : from(0)) stretches += motion.stretches.size();
  return std::max<std::uint64_t>(1, stretches / kUsual);
}

double MotionSet::quickCost(const Motion& motion, maps::Point from) const noexcept {
  const maps::Grid& grid = map_.grid();
  const auto code = [&](double dx_m, double dy_m) {
    const double column = (from.x_m + dx_m - grid.south_west.x_m) * inverse_resolution_;
    const double row = (from.y_m + dy_m - grid.south_west.y_m) * inverse_resolution_;
    if (!(column >= 0.0 && row >= 0.0 && column < grid.width && row < grid.height))
      return costmap::CellCode({.curve = costmap::CellCode::kBlocked});
    return map_.at({static_cast<int>(column), static_cast<int>(row)});
  };
  double sum = 0.0;
  for (const Stretch& stretch : motion.stretches) {
    const float metre_J = stretch.cost(code(stretch.dx_m, stretch.dy_m));
    if (metre_J == std::numeric_limits<float>::infinity()) return kInfinity;
    sum += static_cast<double>(metre_J) * stretch.length_m;
  }
  if (motion.turn_rad == 0.0) return sum;
  const TurnCosts& turns = kinematics_.turnsOn(code(0.0, 0.0).curve());
  if (motion.direction == 0) return sum + kinematics_.stop.cost_J + turns.in_place.cost_J * motion.turn_rad;
  return sum + turns.on_arc.cost_J * motion.turn_rad;
}

}  // namespace talus::planner
