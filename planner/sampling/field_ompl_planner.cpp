#include <chrono>
#include <thread>
#include <utility>

#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>

#include <talus/planner/sampling/field_ompl_planner.hpp>
#include <talus/planner/sampling/map_space.hpp>

namespace talus::planner {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

// Requests a stop when OMPL's termination condition is met. The condition can only be polled.
class StopWhen {
 public:
  explicit StopWhen(const ob::PlannerTerminationCondition& done)
      : asking_([this, &done](const std::stop_token& over) {
          while (!over.stop_requested() && !done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
          if (!over.stop_requested()) source_.request_stop();
        }) {}

  std::stop_token token() const noexcept { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread asking_;
};

ob::PlannerStatus statusOf(const Plan& plan) {
  switch (plan.status) {
    case RouteStatus::Found:
      return ob::PlannerStatus::EXACT_SOLUTION;
    case RouteStatus::StartInvalid:
      return ob::PlannerStatus::INVALID_START;
    case RouteStatus::GoalInvalid:
      return ob::PlannerStatus::INVALID_GOAL;
    case RouteStatus::NoRoute:
    case RouteStatus::NoneFound:
      return ob::PlannerStatus::ABORT;
    default:
      return ob::PlannerStatus::TIMEOUT;
  }
}

}  // namespace

FieldOmplPlanner::FieldOmplPlanner(const ob::SpaceInformationPtr& space,
                                   std::shared_ptr<const costmap::CostGrid> map, int threads)
    : Planner(space, "Field"),
      map_(std::move(map)),
      threads_(threads),
      field_(std::make_unique<FieldPlanner>()) {
  specs_.approximateSolutions = false;
  specs_.optimizingPaths = true;
  specs_.recognizedGoal = ob::GOAL_STATE;
}

void FieldOmplPlanner::clear() {
  Planner::clear();
  field_ = std::make_unique<FieldPlanner>();
}

ob::PlannerStatus FieldOmplPlanner::solve(const ob::PlannerTerminationCondition& done) {
  checkValidity();
  const auto* goal = dynamic_cast<const ob::GoalState*>(pdef_->getGoal().get());
  if (!goal) return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  if (pdef_->getStartStateCount() == 0) return ob::PlannerStatus::INVALID_START;
  const StopWhen stop(done);
  Problem problem{.map = map_,
                  .start = MapSpace::place(pdef_->getStartState(0)),
                  .goal = MapSpace::place(goal->getState()),
                  .threads = threads_};
  problem.watch.stop = stop.token();
  if (goal->getThreshold() > 1e-9) problem.goal_tolerance_m = goal->getThreshold();
  const Plan plan = field_->plan(problem);
  if (plan.status == RouteStatus::Found) {
    ob::PlannerSolution solution(pathOf(plan));
    solution.setPlannerName(getName());
    if (const auto objective = pdef_->getOptimizationObjective())
      solution.setOptimized(objective, ob::Cost(plan.cost_J), false);
    pdef_->addSolutionPath(solution);
  }
  return statusOf(plan);
}

ob::PathPtr FieldOmplPlanner::pathOf(const Plan& plan) const {
  auto path = std::make_shared<og::PathGeometric>(si_);
  ob::State* state = si_->allocState();
  for (const maps::Point place : plan.points) {
    MapSpace::setPlace(state, place);
    path->append(state);
  }
  si_->freeState(state);
  return path;
}

}  // namespace talus::planner
