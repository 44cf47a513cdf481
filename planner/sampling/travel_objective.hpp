#pragma once

#include <cstdint>
#include <memory>

#include <ompl/base/OptimizationObjective.h>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/sampling/metered_cost.hpp>

namespace talus::planner {

/// Cost [J] of a motion that is not allowed. The value is finite, because sums and comparisons of OMPL fail
/// with infinite values. It exceeds the cost of any real route; sums with this value have a resolution of
/// about 0.1 J.
inline constexpr double kBlockedMotionCost_J = 1e15;

/// Optimisation objective of OMPL that minimises the cost of a route [J] (MotionCost). It is not symmetric,
/// because ascent and descent differ. For states of MapSpace.
class TravelObjective : public ompl::base::OptimizationObjective {
 public:
  /// Parts of the objective: the cost function, the region in which samples are drawn, and a seed.
  struct Parts {
    std::shared_ptr<const MeteredCost> cost;
    std::shared_ptr<const ImprovableRegion> region;
    std::uint64_t seed = 1;  ///< seed of the informed samplers
  };

  TravelObjective(const ompl::base::SpaceInformationPtr& space, Parts parts);

  bool isSymmetric() const override { return false; }

  /// Returns 0, because only motions have a cost.
  ompl::base::Cost stateCost(const ompl::base::State* state) const override;

  /// Returns the exact cost of a motion [J]; kBlockedMotionCost_J if the motion is not allowed.
  ompl::base::Cost motionCost(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Returns an admissible lower bound of the cost of the cheapest path between two states [J].
  ompl::base::Cost motionCostHeuristic(const ompl::base::State* from,
                                       const ompl::base::State* to) const override;

  /// Returns a sampler of the region through which a route cheaper than the best known route can lead.
  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& problem,
                                                           unsigned int max_calls) const override;

 private:
  Parts parts_;
};

}  // namespace talus::planner
