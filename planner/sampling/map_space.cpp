#include <algorithm>
#include <limits>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
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
