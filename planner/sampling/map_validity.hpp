#pragma once

#include <memory>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>

#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

/// A state is valid if its cell allows some heading. For states of MapSpace.
class MapValidityChecker : public ompl::base::StateValidityChecker {
 public:
  MapValidityChecker(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool isValid(const ompl::base::State* state) const override;

 private:
  std::shared_ptr<const MeteredCost> cost_;
};

/// A straight motion is valid if every crossed cell allows its heading; the reverse motion may differ. Exact:
/// the motion is not sampled. For states of MapSpace.
class MapMotionValidator : public ompl::base::MotionValidator {
 public:
  MapMotionValidator(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Finds the last valid state by bisection, to 1/256 of the motion.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  bool allowed(const ompl::base::State* from, const ompl::base::State* to) const;

  std::shared_ptr<const MeteredCost> cost_;
};

}  // namespace talus::planner
