#include <cmath>
#include <limits>
#include <utility>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateProjections.h>

#include <talus/planner/sampling/map_space.hpp>

namespace talus::planner {
namespace {

// The map's east and north edges belong to no cell, so the largest coordinate lies just inside.
double lastInside(double edge) {
  return std::nextafter(edge, -std::numeric_limits<double>::infinity());
}

}  // namespace

MapSpace::MapSpace(const maps::Grid& grid) : RealVectorStateSpace(2), grid_(grid) {
  setName("Map");
  setDimensionName(0, "x_m");
  setDimensionName(1, "y_m");
  ompl::base::RealVectorBounds bounds(2);
  bounds.setLow(0, grid.south_west.x_m);
  bounds.setLow(1, grid.south_west.y_m);
  bounds.setHigh(0, lastInside(grid.south_west.x_m + grid.width * grid.resolution_m));
  bounds.setHigh(1, lastInside(grid.south_west.y_m + grid.height * grid.resolution_m));
  setBounds(bounds);
}

void MapSpace::registerProjections() {
  constexpr double side_cells = 16.0;
  const std::vector<double> sizes(2, side_cells * grid_.resolution_m);
  registerDefaultProjection(std::make_shared<ompl::base::RealVectorIdentityProjectionEvaluator>(this, sizes));
}

double MeteredCost::operator()(const Segment& motion) const noexcept {
  if (motion.from == last_.from && motion.to == last_.to) return last_cost_J_;
  const double metres = std::hypot(motion.to.x_m - motion.from.x_m, motion.to.y_m - motion.from.y_m);
  work_ += 1 + static_cast<std::uint64_t>(metres / motion_.map().grid().resolution_m);
  last_ = motion;
  last_cost_J_ = turnsAllowed(motion) ? motion_(motion) : std::numeric_limits<double>::infinity();
  return last_cost_J_;
}

bool MeteredCost::turnsAllowed(const Segment& motion) const noexcept {
  return (motion.from == ends_.from || motion_.turnAllowed(motion, motion.from)) &&
         (motion.to == ends_.to || motion_.turnAllowed(motion, motion.to));
}

MapValidityChecker::MapValidityChecker(const ompl::base::SpaceInformationPtr& space,
                                       std::shared_ptr<const MeteredCost> cost)
    : StateValidityChecker(space), cost_(std::move(cost)) {}

bool MapValidityChecker::isValid(const ompl::base::State* state) const {
  return cost_->motion().allowed(MapSpace::place(state));
}

MapMotionValidator::MapMotionValidator(const ompl::base::SpaceInformationPtr& space,
                                       std::shared_ptr<const MeteredCost> cost)
    : MotionValidator(space), cost_(std::move(cost)) {}

bool MapMotionValidator::allowed(const ompl::base::State* from, const ompl::base::State* to) const {
  return std::isfinite((*cost_)({MapSpace::place(from), MapSpace::place(to)}));
}

bool MapMotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to) const {
  const bool valid = allowed(from, to);
  ++(valid ? valid_ : invalid_);
  return valid;
}

bool MapMotionValidator::checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                                     std::pair<ompl::base::State*, double>& last_valid) const {
  if (checkMotion(from, to)) return true;
  const auto& space = *si_->getStateSpace();
  ompl::base::State* probe = si_->allocState();
  double good = 0.0;
  for (double step = 0.5; step >= 1.0 / 256; step /= 2) {
    space.interpolate(from, to, good + step, probe);
    if (allowed(from, probe)) good += step;
  }
  if (last_valid.first) space.interpolate(from, to, good, last_valid.first);
  last_valid.second = good;
  si_->freeState(probe);
  return false;
}

}  // namespace talus::planner
