#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <sstream>
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

#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

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

SamplingSettings samplingSettings(const std::string& words) {
  std::istringstream parts(words);
  std::string word;
  std::getline(parts, word, ':');
  SamplingSettings settings{.planner = plannerName(word)};
  while (std::getline(parts, word, ':')) {
    const std::size_t equals = word.find('=');
    if (word == "cold")
      settings.cold = true;
    else if (equals != std::string::npos && equals > 0)
      settings.parameters[word.substr(0, equals)] = word.substr(equals + 1);
    else
      throw std::invalid_argument("planner '" + words + "': '" + word + "' is neither cold nor NAME=VALUE");
  }
  if (settings.cold || !settings.parameters.empty()) checkParameters(settings.planner, settings.parameters);
  return settings;
}

std::vector<std::string> warmAndCold() {
  std::vector<std::string> all = plannerNames();
  for (const std::string& name : plannerNames())
    if (isOmpls(name)) all.push_back(name + ":cold");
  return all;
}

std::string wordsOf(const SamplingSettings& settings) {
  std::string words = settings.planner + (settings.cold ? ":cold" : "");
  for (const auto& [name, value] : settings.parameters) words += ":" + name + "=" + value;
  return words;
}

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Clock = std::chrono::steady_clock;

std::shared_ptr<const ImprovableRegion> regionOf(const Problem& leg, const Plan& known,
                                                 const SamplingSettings& settings) {
  const double spacing_m = settings.range_cells / 4 * leg.map->grid().resolution_m;
  const bool seeded = known.status == RouteStatus::Found;
  return std::make_shared<ImprovableRegion>(ImprovableRegion::Parts{
      .map = leg.map,
      .start = leg.start,
      .goal = leg.goal,
      .goal_tolerance_m = leg.goal_tolerance_m,
      .known_route = seeded ? subdivided(known.points, spacing_m) : std::vector<maps::Point>{},
      .known_cost_J = known.cost_J,
      .hand_out_route = !settings.planner.ends_with("RRTstar")});  // RRT* inserts the route into its tree
}

ob::SpaceInformationPtr spaceOf(const Problem& leg, const std::shared_ptr<const MeteredCost>& cost,
                                const std::shared_ptr<const ImprovableRegion>& region) {
  auto space = std::make_shared<MapSpace>(leg.map->grid());
  space->setStateSamplerAllocator([region, seed = leg.seed](const ob::StateSpace* of) {
    return std::make_shared<RegionSampler>(of, region, seed);
  });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<MapValidityChecker>(information, cost));
  information->setMotionValidator(std::make_shared<MapMotionValidator>(information, cost));
  information->setup();
  return information;
}

ob::ProblemDefinitionPtr definitionOf(const Problem& leg, const ob::SpaceInformationPtr& space,
                                      const TravelObjective::Parts& parts) {
  auto definition = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<MapSpace> start(space);
  ob::ScopedState<MapSpace> goal(space);
  MapSpace::setPlace(start.get(), leg.start);
  MapSpace::setPlace(goal.get(), leg.goal);
  // OMPL requires a distance below the threshold, so 0 would never be reached.
  const double threshold_m = std::max(leg.goal_tolerance_m, 1e-9 * leg.map->grid().resolution_m);
  definition->setStartAndGoalStates(start, goal, threshold_m);
  definition->setOptimizationObjective(std::make_shared<TravelObjective>(space, parts));
  return definition;
}

// A time limit is used up completely; without a time limit the work limit ends the run, equally on every
// machine.
bool spent(const Problem& leg, const SamplingSettings& settings, const MeteredCost& cost) {
  return std::isinf(leg.time_limit_s) && cost.work() >= settings.work;
}

// Completed share of the time limit, or of the work limit if there is no time limit.
double shareDone(const Problem& leg, const SamplingSettings& settings, const MeteredCost& cost,
                 double elapsed_s) {
  const double share = std::isinf(leg.time_limit_s)
                           ? static_cast<double>(cost.work()) / static_cast<double>(settings.work)
                           : elapsed_s / leg.time_limit_s;
  return std::clamp(share, 0.0, 1.0);
}

// Ends at the work or time limit or when stopped; reports progress ten times a second.
ob::PlannerTerminationCondition doneWhen(const Problem& leg, const SamplingSettings& settings,
                                         const std::shared_ptr<const MeteredCost>& cost) {
  const auto begin = Clock::now();
  const auto reported_s = std::make_shared<double>(-1.0);
  return ob::PlannerTerminationCondition([=, &leg] {
    cost->iterated();
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (elapsed_s > *reported_s + 0.1) {
      *reported_s = elapsed_s;
      leg.watch.report(shareDone(leg, settings, *cost, elapsed_s));
    }
    return spent(leg, settings, *cost) || leg.watch.stopped() || elapsed_s > leg.time_limit_s;
  });
}

// Best of the planner's solutions by exact cost; OMPL's sums may include blocked motions.
Plan priced(const ob::ProblemDefinition& definition, const MotionCost& cost) {
  Plan best;
  for (const ob::PlannerSolution& solution : definition.getSolutions()) {
    if (solution.approximate_) continue;
    Plan plan;
    const auto path = std::dynamic_pointer_cast<og::PathGeometric>(solution.path_);
    for (const ob::State* state : path->getStates()) plan.points.push_back(MapSpace::place(state));
    plan.cost_J = cost.along(plan.points);
    if (plan.cost_J < best.cost_J) best = std::move(plan);
  }
  if (std::isfinite(best.cost_J)) best.status = RouteStatus::Found;
  return best;
}

Plan explained(Plan plan, const Problem& leg, const MeteredCost& cost, const SamplingSettings& settings) {
  const bool stopped = leg.watch.stopped();
  if (plan.status == RouteStatus::Found) return plan;
  plan.points.clear();
  plan.cost_J = std::numeric_limits<double>::infinity();
  const bool worked = spent(leg, settings, cost);
  plan.status = stopped ? RouteStatus::Cancelled : worked ? RouteStatus::NoneFound : RouteStatus::TimedOut;
  plan.reason =
      settings.planner +
      (stopped  ? " was cancelled"
       : worked ? " found no route within its work limit; planner 'field' decides whether a route exists"
                : " found no route within the time limit; increase it or use planner 'field'");
  return plan;
}

SamplingSettings validated(SamplingSettings settings) {
  settings.planner = plannerName(settings.planner);
  if (settings.planner == "field") throw std::invalid_argument("planner 'field' does not sample");
  if (settings.work == 0) throw std::invalid_argument("sampling: work = 0, must be > 0");
  if (!(settings.range_cells > 0))
    throw std::invalid_argument("sampling: range_cells = " + std::to_string(settings.range_cells) +
                                ", must be > 0");
  return settings;
}

Plan checkEnds(const Problem& leg) {
  const MotionCost cost(leg.map);
  if (!cost.allowed(leg.start))
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*leg.map, "start", leg.start));
  if (!cost.allowed(leg.goal) && !(leg.goal_tolerance_m > 0))
    return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*leg.map, "goal", leg.goal));
  return failedPlan(RouteStatus::Found, {});
}

Plan arrived(const Problem& leg) {
  Plan plan = failedPlan(RouteStatus::Found, {});
  plan.points = {leg.start};
  plan.cost_J = 0.0;
  return plan;
}

Plan planLeg(Problem leg, const SamplingSettings& settings, const InitialPathProvider& scout) {
  const TimeLeft clock(leg.time_limit_s);
  if (Plan ends = checkEnds(leg); ends.status != RouteStatus::Found) return ends;
  const double apart_m = std::hypot(leg.goal.x_m - leg.start.x_m, leg.goal.y_m - leg.start.y_m);
  if (apart_m <= leg.goal_tolerance_m) return arrived(leg);
  Problem scouted = leg;
  scouted.watch.progress = {};  // only the sampling planner reports progress
  Plan known = scout ? scout(scouted) : Plan{};
  if (known.status == RouteStatus::Cancelled || known.status == RouteStatus::NoRoute) return known;
  if (settings.better && known.status == RouteStatus::Found) settings.better(known.cost_J);
  const bool seeded = known.status == RouteStatus::Found;
  leg.time_limit_s = clock.left_s();
  if (seeded && (leg.watch.stopped() || !(leg.time_limit_s > 0.0))) return known;
  if (!(leg.time_limit_s > 0.0)) return cancelledPlan(StopCheck(leg.watch));
  Plan found = runOmpl(leg, settings, known);
  if (found.status == RouteStatus::Found) {
    const MotionCost cost(leg.map);
    found.points = withoutCloseVertices(cost, std::move(found.points));
    found.cost_J = cost.along(found.points);
  }
  return seeded && known.cost_J <= found.cost_J ? known : found;
}

}  // namespace

Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known) {
  const QuietOmpl quiet;
  const double range_m = settings.range_cells * leg.map->grid().resolution_m;
  const auto cost = std::make_shared<const MeteredCost>(leg.map, Segment{leg.start, leg.goal});
  const auto region = regionOf(leg, known, settings);
  const auto space = spaceOf(leg, cost, region);
  const auto definition = definitionOf(leg, space, {.cost = cost, .region = region, .seed = leg.seed});
  const PlannerParts parts{.space = space,
                           .definition = definition,
                           .known_route = region->parts().known_route,
                           .range_m = range_m,
                           .seed = leg.seed,
                           .parameters = settings.parameters};
  const ob::PlannerPtr planner = makeOmplPlanner(settings.planner, parts);
  if (settings.better)
    definition->setIntermediateSolutionCallback(
        [&settings](const ob::Planner*, const std::vector<const ob::State*>&, ob::Cost found) {
          if (found.value() < kBlockedMotionCost_J) settings.better(found.value());
        });
  planner->solve(doneWhen(leg, settings, cost));
  Plan plan = explained(priced(*definition, cost->motion()), leg, *cost, settings);
  plan.lower_bound_J = std::max(known.lower_bound_J, region->toGoal(leg.start));
  plan.proof_s = known.proof_s;
  return plan;
}

Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout) {
  const SamplingSettings checked = validated(settings);
  const TimeLeft clock(problem.time_limit_s);
  std::size_t legs = problem.via.size() + 1;
  return planByLegs(problem, [&](Problem leg) {
    leg.time_limit_s = clock.share_s(legs--);  // time left over by earlier legs is shared
    return planLeg(std::move(leg), checked, scout);
  });
}

}  // namespace talus::planner
