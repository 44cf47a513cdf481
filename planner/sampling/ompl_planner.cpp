#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/sst/SST.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <talus/planner/route/polyline.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>

namespace talus::planner {

namespace {

// OMPL's log handler and seed generator are process-wide, so this state is, too.
struct Shared {
  std::mutex mutex;
  int quiet = 0;
};

Shared& shared() {
  static Shared instance;
  return instance;
}

namespace ob = ompl::base;
namespace og = ompl::geometric;

ob::PlannerPtr rrtStar(const PlannerParts& parts, bool informed) {
  auto planner = std::make_shared<SeededRRTstar>(
      parts.space,
      SeededRRTstar::Seed{.route = parts.known_route, .spacing_m = parts.range_m / 4, .informed = informed});
  planner->setRange(parts.range_m);
  return planner;
}

template <typename Bit>
ob::PlannerPtr bitStar(const PlannerParts& parts) {
  auto planner = std::make_shared<Bit>(parts.space);
  planner->setUseKNearest(true);
  planner->setSamplesPerBatch(500);
  planner->setPruning(false);  // pruning needs a measure of the informed set, which has no closed form here
  return planner;
}

ob::PlannerPtr sst(const PlannerParts& parts) {
  auto planner = std::make_shared<og::SST>(parts.space);
  planner->setRange(parts.range_m);
  planner->setSelectionRadius(parts.range_m / 4);
  planner->setPruningRadius(parts.range_m / 16);
  return planner;
}

// FMT* [janson_2015], restarted with twice the samples until stopped. OMPL's FMT measures distance by the
// cost of motions, which is no metric here; its own continuation ("extended") reads past the end of empty
// neighbourhoods.
class RestartedFMT : public og::FMT {
 public:
  explicit RestartedFMT(const ob::SpaceInformationPtr& space) : FMT(space) {
    setExtendedFMT(false);
    setNearestK(false);
    setNumSamples(200);
  }

  void setup() override {
    FMT::setup();
    nn_->setDistanceFunction(
        [this](const Motion* a, const Motion* b) { return si_->distance(a->getState(), b->getState()); });
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& done) override {
    bool solved = false;
    for (;;) {
      solved = bool(FMT::solve(done)) || solved;
      if (done) return {solved, false};
      clear();
      setup();
      setNumSamples(2 * getNumSamples());
    }
  }
};

ob::PlannerPtr named(const std::string& name, const PlannerParts& parts) {
  if (name == "RRTstar") return rrtStar(parts, false);
  if (name == "InformedRRTstar") return rrtStar(parts, true);
  if (name == "BITstar") return bitStar<og::BITstar>(parts);
  if (name == "ABITstar") return bitStar<og::ABITstar>(parts);
  if (name == "SST") return sst(parts);
  if (name == "FMT") return std::make_shared<RestartedFMT>(parts.space);
  return nullptr;
}

void setParameters(ob::Planner& planner, const std::string& name,
                   const std::map<std::string, std::string>& parameters) {
  for (const auto& [key, value] : parameters) {
    if (!planner.params().hasParam(key)) {
      std::vector<std::string> known;
      planner.params().getParamNames(known);
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      throw std::invalid_argument("planner '" + name + "' has no parameter '" + key + "'; it has " + list);
    }
    bool taken = false;
    try {
      taken = planner.params().setParam(key, value);
    } catch (const std::exception&) {  // not a number
    }
    if (!taken)
      throw std::invalid_argument("planner '" + name + "': parameter " + key + " does not take '" + value +
                                  "'");
  }
}

// Planner on a unit plane without a problem.
ob::PlannerPtr unbound(const std::string& name) {
  const auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  plane->setBounds(0.0, 1.0);
  return named(name,
               {.space = std::make_shared<ob::SpaceInformation>(plane), .definition = {}, .known_route = {}});
}

}  // namespace

QuietOmpl::QuietOmpl() {
  const std::lock_guard lock(shared().mutex);
  if (shared().quiet++ == 0) ompl::msg::noOutputHandler();
}

QuietOmpl::~QuietOmpl() {
  const std::lock_guard lock(shared().mutex);
  if (--shared().quiet == 0) ompl::msg::restorePreviousOutputHandler();
}

void withOmplSeed(std::uint64_t seed, const std::function<void()>& make) {
  const QuietOmpl quiet;  // suppresses OMPL's warning about a second seed, which OMPL accepts
  const std::lock_guard lock(shared().mutex);
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed % 0xffffffffu) + 1);
  make();
}

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

bool isOmpls(const std::string& name) {
  return unbound(name) != nullptr;
}

void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters) {
  const QuietOmpl quiet;
  const ob::PlannerPtr planner = unbound(name);
  if (!planner)
    throw std::invalid_argument("planner '" + name +
                                "' is not an OMPL planner; only those begin cold or take parameters");
  setParameters(*planner, name, parameters);
}

ob::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts) {
  ob::PlannerPtr planner;
  withOmplSeed(parts.seed, [&] {
    planner = named(name, parts);
    if (!planner) return;
    setParameters(*planner, name, parts.parameters);
    planner->setProblemDefinition(parts.definition);
    planner->setup();
  });
  return planner;
}

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
