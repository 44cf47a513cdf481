#pragma once

#include <memory>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>

#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

/// Validity of states of MapSpace: a state is valid if its cell allows some heading.
class MapValidityChecker : public ompl::base::StateValidityChecker {
 public:
  MapValidityChecker(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool isValid(const ompl::base::State* state) const override;

 private:
  std::shared_ptr<const MeteredCost> cost_;
};

/// Validity of straight motions between states of MapSpace: a motion is valid if every crossed cell allows
/// its heading. The validity of the reverse motion may differ. The check is exact; the motion is not sampled.
class MapMotionValidator : public ompl::base::MotionValidator {
 public:
  MapMotionValidator(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Checks the motion and stores in `last_valid` its last valid state, found by bisection to 1/256 of the
  /// motion.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  bool allowed(const ompl::base::State* from, const ompl::base::State* to) const;

  std::shared_ptr<const MeteredCost> cost_;
};

}  // namespace talus::planner
