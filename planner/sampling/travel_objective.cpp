#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <ompl/base/goals/GoalState.h>

#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/travel_objective.hpp>

namespace talus::planner {

bool RegionSource::next(double max_cost_J, maps::Point& place) {
  const auto& route = region_->parts().known_route;
  if (region_->parts().hand_out_route && handed_out_ < route.size()) {
    place = route[handed_out_++];
    return true;
  }
  return region_->sample(engine_, max_cost_J, place);
}

RegionSampler::RegionSampler(const ompl::base::StateSpace* space,
                             std::shared_ptr<const ImprovableRegion> region, std::uint64_t seed)
    : StateSampler(space), source_(std::move(region), seed) {}

void RegionSampler::sampleUniform(ompl::base::State* state) {
  maps::Point place = source_.region().parts().start;
  source_.next(std::numeric_limits<double>::infinity(), place);
  MapSpace::setPlace(state, place);
  space_->enforceBounds(state);
}

void RegionSampler::sampleUniformNear(ompl::base::State* state, const ompl::base::State* near,
                                      double distance) {
  std::uniform_real_distribution<double> offset(-distance, distance);
  const maps::Point centre = MapSpace::place(near);
  const double dx = offset(source_.engine());
  const double dy = offset(source_.engine());
  MapSpace::setPlace(state, {centre.x_m + dx, centre.y_m + dy});
  space_->enforceBounds(state);
}

void RegionSampler::sampleGaussian(ompl::base::State* state, const ompl::base::State* mean,
                                   double deviation) {
  std::normal_distribution<double> offset(0.0, deviation);
  const maps::Point centre = MapSpace::place(mean);
  const double dx = offset(source_.engine());
  const double dy = offset(source_.engine());
  MapSpace::setPlace(state, {centre.x_m + dx, centre.y_m + dy});
  space_->enforceBounds(state);
}

RegionInformedSampler::RegionInformedSampler(const Parts& parts)
    : InformedSampler(parts.problem, parts.max_calls), source_(parts.region, parts.seed) {}

bool RegionInformedSampler::sampleUniform(ompl::base::State* state, const ompl::base::Cost& max_cost) {
  maps::Point place;
  if (!source_.next(max_cost.value(), place)) return false;
  MapSpace::setPlace(state, place);
  space_->enforceBounds(state);
  return true;
}

bool RegionInformedSampler::sampleUniform(ompl::base::State* state, const ompl::base::Cost& min_cost,
                                          const ompl::base::Cost& max_cost) {
  return sampleUniform(state, max_cost) && heuristicSolnCost(state).value() >= min_cost.value();
}

double RegionInformedSampler::getInformedMeasure(const ompl::base::Cost&) const {
  return space_->getMeasure();
}

ompl::base::Cost RegionInformedSampler::heuristicSolnCost(const ompl::base::State* state) const {
  const maps::Point place = MapSpace::place(state);
  return ompl::base::Cost(source_.region().fromStart(place) + source_.region().toGoal(place));
}

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
