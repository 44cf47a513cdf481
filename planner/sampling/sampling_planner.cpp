#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>

#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::planner {

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
