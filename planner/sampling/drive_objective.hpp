#pragma once

#include <cstdint>
#include <memory>

#include <ompl/base/OptimizationObjective.h>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

/// Cost of a motion OMPL must not take. Finite: with infinities OMPL's sums and comparisons go wrong. It
/// exceeds the cost of any real route, and in double precision still leaves 0.1 J of the rest of the sum.
inline constexpr double kBlockedMotionCost_J = 1e15;

/// The one cost function as an OMPL objective: minimise joules, by MotionCost. Not symmetric: there and back
/// differ. States of MapSpace.
class DriveObjective : public ompl::base::OptimizationObjective {
 public:
  /// What it stands on.
  struct Parts {
    std::shared_ptr<const MeteredCost> cost;
    std::shared_ptr<const ImprovableRegion> region;
    std::uint64_t seed = 1;  ///< of the informed samplers it hands out
  };

  DriveObjective(const ompl::base::SpaceInformationPtr& space, Parts parts);

  bool isSymmetric() const override { return false; }

  /// Places cost nothing; motions do.
  ompl::base::Cost stateCost(const ompl::base::State* state) const override;

  /// Exact cost in joules; kBlockedMotionCost_J when not allowed.
  ompl::base::Cost motionCost(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Admissible: never above the cost of the best way from one to the other.
  ompl::base::Cost motionCostHeuristic(const ompl::base::State* from,
                                       const ompl::base::State* to) const override;

  /// Samples where a route better than the best one known can still pass.
  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& problem,
                                                           unsigned int max_calls) const override;

 private:
  Parts parts_;
};

}  // namespace talus::planner
