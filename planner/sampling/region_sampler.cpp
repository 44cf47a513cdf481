#include <limits>
#include <utility>

#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/region_sampler.hpp>

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

}  // namespace talus::planner
