#include <cmath>
#include <utility>

#include <ompl/base/SpaceInformation.h>

#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/map_validity.hpp>

namespace talus::planner {

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
