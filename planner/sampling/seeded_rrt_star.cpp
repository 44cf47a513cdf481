#include <utility>

#include <talus/planner/route/polyline.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/seeded_rrt_star.hpp>

namespace talus::planner {

SeededRRTstar::SeededRRTstar(const ompl::base::SpaceInformationPtr& space, Seed seed)
    : RRTstar(space), seed_(std::move(seed)) {
  setName(seed_.informed ? "InformedRRTstar" : "RRTstar");
  setKNearest(false);              // fixed radius: much faster here than k nearest
  setAdmissibleCostToCome(false);  // OMPL's bound, the straight motion's cost, is no lower bound here
  setInformedSampling(true);       // through the objective's sampler
  if (seed_.informed) {
    setTreePruning(true);
    setNewStateRejection(true);
  }
}

ompl::base::PlannerStatus SeededRRTstar::solve(const ompl::base::PlannerTerminationCondition& done) {
  checkValidity();
  if (seed_.route.size() > 1 && nn_->size() == 0) plant();
  return RRTstar::solve(done);
}

void SeededRRTstar::plant() {
  Motion* tip = plantRoot();
  if (!tip) return;
  const std::vector<maps::Point> places = subdivided(seed_.route, seed_.spacing_m);
  for (std::size_t i = 1; i < places.size(); ++i) tip = grow(tip, places[i]);
  tip->inGoal = pdef_->getGoal()->isSatisfied(tip->state);
  if (!tip->inGoal) return;
  goalMotions_.push_back(tip);
  bestGoalMotion_ = tip;
  bestCost_ = tip->cost;
}

ompl::geometric::RRTstar::Motion* SeededRRTstar::plantRoot() {
  const ompl::base::State* start = pis_.nextStart();
  if (!start) return nullptr;
  auto* root = new Motion(si_);
  si_->copyState(root->state, start);
  root->cost = opt_->identityCost();
  nn_->add(root);
  startMotions_.push_back(root);
  return root;
}

ompl::geometric::RRTstar::Motion* SeededRRTstar::grow(Motion* parent, maps::Point place) {
  auto* motion = new Motion(si_);
  MapSpace::setPlace(motion->state, place);
  motion->parent = parent;
  motion->incCost = opt_->motionCost(parent->state, motion->state);
  motion->cost = opt_->combineCosts(parent->cost, motion->incCost);
  parent->children.push_back(motion);
  nn_->add(motion);
  return motion;
}

}  // namespace talus::planner
