#pragma once

#include <cstdint>
#include <memory>

#include <ompl/base/OptimizationObjective.h>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

/// Cost [J] of a motion that is not allowed. Finite, because OMPL's sums and comparisons fail with
/// infinities. Exceeds the cost of any real route; sums with this cost keep a resolution of about 0.1 J.
inline constexpr double kBlockedMotionCost_J = 1e15;

/// The drive cost (MotionCost) as an OMPL optimization objective: minimises joules. Not symmetric, because
/// ascent and descent differ. For states of MapSpace.
class TravelObjective : public ompl::base::OptimizationObjective {
 public:
  /// Cost function, sampled region and seed of the objective.
  struct Parts {
    std::shared_ptr<const MeteredCost> cost;
    std::shared_ptr<const ImprovableRegion> region;
    std::uint64_t seed = 1;  ///< seed of the informed samplers
  };

  TravelObjective(const ompl::base::SpaceInformationPtr& space, Parts parts);

  bool isSymmetric() const override { return false; }

  /// Zero: only motions have a cost.
  ompl::base::Cost stateCost(const ompl::base::State* state) const override;

  /// Exact cost [J]; kBlockedMotionCost_J if the motion is not allowed.
  ompl::base::Cost motionCost(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Admissible lower bound of the cheapest path between the states [J].
  ompl::base::Cost motionCostHeuristic(const ompl::base::State* from,
                                       const ompl::base::State* to) const override;

  /// Sampler of the region through which a route better than the best known one can pass.
  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& problem,
                                                           unsigned int max_calls) const override;

 private:
  Parts parts_;
};

}  // namespace talus::planner
