#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/planner/field/remedy.hpp>
#include <talus/planner/refine/close_vertices.hpp>
#include <talus/planner/route/legs.hpp>
#include <talus/planner/route/plan_end.hpp>
#include <talus/planner/route/planner_names.hpp>
#include <talus/planner/route/time_left.hpp>
#include <talus/planner/sampling/ompl_run.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::planner {
namespace {

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
