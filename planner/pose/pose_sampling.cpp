#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/StateSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/pose/pose_sampling.hpp>
#include <talus/planner/pose/pose_space.hpp>
#include <talus/planner/route/stop_check.hpp>
#include <talus/planner/sampling/ompl_guard.hpp>
#include <talus/planner/sampling/travel_objective.hpp>

namespace talus::planner {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kBeside_rad = 0.3;  // largest deviation of sampled headings from the known drive
constexpr double kBeside_cells = 6.0;
constexpr std::uint64_t kIteration = 100;  // work of one iteration [cells]

PosePath joined(const std::vector<Pose>& poses, const PoseCost& cost) {
  PosePath path{.start = poses.front(), .legs = {}};
  Pose at = path.start;
  for (std::size_t i = 1; i < poses.size(); ++i)
    for (const PosePath::Leg& leg : cost.direct(at, poses[i])) {
      path.legs.push_back(leg);
      at = after(at, leg);
    }
  return path;
}

// Computes costs of drives and counts the work.
class MeteredPoseCost {
 public:
  explicit MeteredPoseCost(const PoseCost& cost) : cost_(cost) {}

  double operator()(const ob::State* from, const ob::State* to) const {
    const Pose a = PoseSpace::pose(from), b = PoseSpace::pose(to);
    PosePath path{.start = a, .legs = cost_.direct(a, b)};
    work_ += 1 + static_cast<std::uint64_t>(length_m(path) / cost_.motion().map().grid().resolution_m);
    return cost_(path);
  }

  void iterated() const noexcept { work_ += kIteration; }
  std::uint64_t work() const noexcept { return work_; }
  const PoseCost& cost() const noexcept { return cost_; }

 private:
  const PoseCost& cost_;
  mutable std::uint64_t work_ = 0;
};

class Objective : public ob::OptimizationObjective {
 public:
  Objective(const ob::SpaceInformationPtr& space, const MeteredPoseCost& cost)
      : OptimizationObjective(space), cost_(cost) {
    description_ = "drive cost with turning [J]";
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(std::min(cost_(from, to), kBlockedMotionCost_J));
  }
  bool isSymmetric() const override { return false; }

 private:
  const MeteredPoseCost& cost_;
};

class Validator : public ob::MotionValidator {
 public:
  Validator(const ob::SpaceInformationPtr& space, const MeteredPoseCost& cost)
      : MotionValidator(space), cost_(cost) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return std::isfinite(cost_(from, to));
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const MeteredPoseCost& cost_;
};

// Draws half of the samples near the known drive, the others anywhere in the improvable region with any
// heading.
class Sampler : public ob::StateSampler {
 public:
  struct Parts {
    const ImprovableRegion& region;
    std::vector<Pose> known;
    double reach_m;
    std::uint64_t seed;
  };
  Sampler(const ob::StateSpace* space, const Parts& parts)
      : StateSampler(space), parts_(parts), engine_(parts.seed) {}

  void sampleUniform(ob::State* state) override {
    Pose pose;
    if (unit() < 0.5) {
      pose = parts_.known[static_cast<std::size_t>(unit() * static_cast<double>(parts_.known.size()))];
      pose.place.x_m += parts_.reach_m * (2.0 * unit() - 1.0);
      pose.place.y_m += parts_.reach_m * (2.0 * unit() - 1.0);
      pose.heading_rad += kBeside_rad * (2.0 * unit() - 1.0);
    } else {
      pose.place = parts_.known.front().place;
      parts_.region.sample(engine_, parts_.region.parts().known_cost_J, pose.place);
      pose.heading_rad = 2.0 * std::numbers::pi * unit();
    }
    PoseSpace::setPose(state, pose);
    space_->enforceBounds(state);
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }

 private:
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  Parts parts_;
  ImprovableRegion::Engine engine_;
};

// RRT* with a tree that initially contains a drive.
class WarmStartedRrtStar : public og::RRTstar {
 public:
  WarmStartedRrtStar(const ob::SpaceInformationPtr& space, std::vector<Pose> drive)
      : RRTstar(space), drive_(std::move(drive)) {
    setKNearest(true);  // curves are no metric: a radius search would return all nodes
    setAdmissibleCostToCome(false);
    setInformedSampling(false);
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& done) override {
    checkValidity();
    if (nn_->size() == 0) plant();
    return RRTstar::solve(done);
  }

 private:
  void plant() {
    Motion* tip = nullptr;
    for (const Pose& pose : drive_) {
      auto* motion = new Motion(si_);
      PoseSpace::setPose(motion->state, pose);
      motion->cost = opt_->identityCost();
      motion->parent = tip;
      if (tip) {
        motion->incCost = opt_->motionCost(tip->state, motion->state);
        motion->cost = opt_->combineCosts(tip->cost, motion->incCost);
        tip->children.push_back(motion);
      } else {
        pis_.nextStart();
        startMotions_.push_back(motion);
      }
      nn_->add(motion);
      tip = motion;
    }
    tip->inGoal = pdef_->getGoal()->isSatisfied(tip->state);
    if (!tip->inGoal) return;
    goalMotions_.push_back(tip);
    bestGoalMotion_ = tip;
    bestCost_ = tip->cost;
  }

  std::vector<Pose> drive_;
};

std::vector<Pose> jointsOf(const PosePath& path) {
  std::vector<Pose> poses{path.start};
  for (const PosePath::Leg& leg : path.legs) poses.push_back(after(poses.back(), leg));
  return poses;
}

ImprovableRegion regionOf(const PoseProblem& problem, const PosePlan& known,
                          const std::vector<Pose>& joints) {
  std::vector<maps::Point> route;
  for (const Pose& pose : joints) route.push_back(pose.place);
  return ImprovableRegion({.map = problem.map,
                           .start = problem.start,
                           .goal = problem.goal,
                           .known_route = std::move(route),
                           .known_cost_J = known.cost_J});
}

void improve(PosePlan& plan, const ob::ProblemDefinition& definition, const PoseProblem& problem,
             const PoseCost& cost) {
  for (const ob::PlannerSolution& solution : definition.getSolutions()) {
    if (solution.approximate_) continue;
    std::vector<Pose> poses;
    for (const ob::State* state : std::dynamic_pointer_cast<og::PathGeometric>(solution.path_)->getStates())
      poses.push_back(PoseSpace::pose(state));
    PosePath path = joined(poses, cost);
    const double cost_J = cost(path);
    if (cost_J >= plan.cost_J || !mayBeDriven(*problem.map, path, problem.kinematics)) continue;
    plan.path = std::move(path);
    plan.cost_J = cost_J;
  }
}

}  // namespace

PosePlan improvedBySampling(const PoseProblem& problem, const PosePlan& known,
                            const PoseSamplingSettings& settings) {
  PosePlan plan = known;
  if (known.status != RouteStatus::Found || known.path.legs.empty()) return plan;
  const QuietOmpl quiet;
  const MotionCost motion(problem.map);
  const PoseCost cost(motion, problem.kinematics);
  const MeteredPoseCost metered(cost);
  const auto joints = jointsOf(known.path);
  const ImprovableRegion region = regionOf(problem, known, joints);
  const double cell_m = problem.map->grid().resolution_m;
  const auto space = std::make_shared<PoseSpace>(cost);
  space->setStateSamplerAllocator([&](const ob::StateSpace* of) {
    return std::make_shared<Sampler>(of,
                                     Sampler::Parts{region, joints, kBeside_cells * cell_m, settings.seed});
  });
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      [&](const ob::State* state) { return motion.allowed(PoseSpace::pose(state).place); });
  information->setMotionValidator(std::make_shared<Validator>(information, metered));
  information->setup();
  const auto definition = std::make_shared<ob::ProblemDefinition>(information);
  ob::ScopedState<PoseSpace> start(space), goal(space);
  PoseSpace::setPose(start.get(), joints.front());
  PoseSpace::setPose(goal.get(), joints.back());
  definition->setStartAndGoalStates(start, goal, 1e-6 * cell_m);
  definition->setOptimizationObjective(std::make_shared<Objective>(information, metered));
  if (settings.better)
    definition->setIntermediateSolutionCallback(
        [&settings](const ob::Planner*, const std::vector<const ob::State*>&, ob::Cost found) {
          if (found.value() < kBlockedMotionCost_J) settings.better(found.value());
        });
  const StopCheck stop(problem.watch, problem.time_limit_s);
  withOmplSeed(settings.seed, [&] {
    WarmStartedRrtStar planner(information, joints);
    planner.setRange(settings.range_cells * cell_m);
    planner.setProblemDefinition(definition);
    planner.setup();
    planner.solve(ob::PlannerTerminationCondition([&] {
      metered.iterated();
      return (std::isinf(problem.time_limit_s) && metered.work() >= settings.work) || stop();
    }));
  });
  improve(plan, *definition, problem, cost);
  if (problem.watch.stopped()) plan.status = RouteStatus::Cancelled, plan.reason = "cancelled";
  return plan;
}

}  // namespace talus::planner
