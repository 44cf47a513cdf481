#include <algorithm>
#include <cmath>
#include <utility>

#include <ompl/base/goals/GoalState.h>

#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/region_sampler.hpp>
#include <talus/planner/sampling/travel_objective.hpp>

namespace talus::planner {

TravelObjective::TravelObjective(const ompl::base::SpaceInformationPtr& space, Parts parts)
    : OptimizationObjective(space), parts_(std::move(parts)) {
  description_ = "drive cost [J]";
  setCostToGoHeuristic([region = parts_.region](const ompl::base::State* state, const ompl::base::Goal*) {
    return ompl::base::Cost(region->toGoal(MapSpace::place(state)));
  });
}

ompl::base::Cost TravelObjective::stateCost(const ompl::base::State*) const {
  return identityCost();
}

ompl::base::Cost TravelObjective::motionCost(const ompl::base::State* from,
                                             const ompl::base::State* to) const {
  return ompl::base::Cost(
      std::min((*parts_.cost)({MapSpace::place(from), MapSpace::place(to)}), kBlockedMotionCost_J));
}

ompl::base::Cost TravelObjective::motionCostHeuristic(const ompl::base::State* from,
                                                      const ompl::base::State* to) const {
  const ImprovableRegion& region = *parts_.region;
  const Segment ends{MapSpace::place(from), MapSpace::place(to)};
  double bound_J = region.between(ends);
  if (ends.from == region.parts().start) bound_J = std::max(bound_J, region.fromStart(ends.to));
  if (ends.to == region.parts().goal) bound_J = std::max(bound_J, region.toGoal(ends.from));
  return ompl::base::Cost(std::min(bound_J, kBlockedMotionCost_J));
}

ompl::base::InformedSamplerPtr TravelObjective::allocInformedStateSampler(
    const ompl::base::ProblemDefinitionPtr& problem, unsigned int max_calls) const {
  return std::make_shared<RegionInformedSampler>(RegionInformedSampler::Parts{
      .problem = problem, .max_calls = max_calls, .region = parts_.region, .seed = parts_.seed});
}

}  // namespace talus::planner
