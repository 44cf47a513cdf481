#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/planner/field/map_change.hpp>
#include <talus/planner/field/pooled_grid.hpp>
#include <talus/planner/field/remedy.hpp>
#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/refine/close_vertices.hpp>
#include <talus/planner/route/added_time.hpp>
#include <talus/planner/route/legs.hpp>
#include <talus/planner/route/plan_end.hpp>

namespace talus::planner {
namespace {

// The place itself, or a nearby cell centre, at most kFar cells away, with an allowed heading.
std::optional<maps::Point> standingPlace(const MotionCost& cost, maps::Point p) {
  constexpr int kFar = 8;
  if (cost.allowed(p)) return p;
  const maps::Grid& grid = cost.map().grid();
  const auto own = grid.cellAt(p);
  if (!own) return std::nullopt;
  for (int ring = 1; ring <= kFar; ++ring)
    for (int row = own->row - ring; row <= own->row + ring; ++row)
      for (int column = own->column - ring; column <= own->column + ring; ++column)
        if (grid.contains({column, row}) && cost.allowed(grid.centre({column, row})))
          return grid.centre({column, row});
  return std::nullopt;
}

}  // namespace

// Refinement for the guide, which need not be more accurate than the tube's width.
RefineOptions TubePlanner::roughly() {
  RefineOptions rough;
  rough.corridor.reach_cells = 0;
  return rough;
}

Plan TubePlanner::plan(const Problem& problem) {
  if (!problem.map) throw std::invalid_argument("TubePlanner: no map");
  const StopCheck stop(problem.watch, problem.time_limit_s);
  return planByLegs(problem, [&](const Problem& leg) { return planLeg(leg, stop); });
}

Plan TubePlanner::planLeg(const Problem& leg, const StopCheck& stop) {
  const MotionCost cost(leg.map);
  if (!cost.allowed(leg.start))
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*leg.map, "start", leg.start));
  if (!mayEnd(cost, leg.goal, leg.goal_tolerance_m))
    return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*leg.map, "goal", leg.goal));
  if (!pool(leg, stop)) return cancelledPlan(stop);
  Polyline way;
  if (const Polyline along = guideOver(pooled_, leg); !along.empty())
    way = tubeRoute(leg, along, options_, stop);
  if (stop()) return cancelledPlan(stop);
  if (!way.empty()) return finished(leg, std::move(way), stop);
  Problem proof = leg;
  proof.prove = false;
  return whole_.plan(proof);
}

Plan TubePlanner::planAlong(const Problem& problem, const Polyline& guide) {
  const StopCheck stop(problem.watch, problem.time_limit_s);
  const MotionCost cost(problem.map);
  if (!cost.allowed(problem.start))
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*problem.map, "start", problem.start));
  if (!mayEnd(cost, problem.goal, problem.goal_tolerance_m))
    return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*problem.map, "goal", problem.goal));
  Polyline way = tubeRoute(problem, guide, options_, stop);
  if (stop()) return cancelledPlan(stop);
  if (way.empty())
    return failedPlan(
        RouteStatus::NoneFound,
        "no route found near the route over the overview; read a part with --window, or the whole map");
  return finished(problem, std::move(way), stop);
}

Plan TubePlanner::finished(const Problem& leg, Polyline way, const StopCheck& stop) {
  const MotionCost cost(leg.map);
  Plan plan{RouteStatus::Found,
            {},
            withoutCloseVertices(cost, cutWithin(refine_(cost, std::move(way), leg.threads, stop), leg.goal,
                                                 leg.goal_tolerance_m)),
            0.0,
            0.0};
  plan.cost_J = cost.along(plan.points);
  const Segment ends{leg.start, leg.goal};
  const auto proven_J = [&] {
    const AddedTime proof(plan.proof_s);
    return straightBoundOver_J(*leg.map, ends, leg.goal_tolerance_m, plan.cost_J, stop);
  };
  plan.lower_bound_J = std::min(plan.cost_J, leg.prove ? proven_J() : 0.0);
  return withoutTipping(std::move(plan));
}

// Pools the map, or only the cells that changed since the previous call.
bool TubePlanner::pool(const Problem& problem, const StopCheck& stop) {
  if (problem.map == map_) return true;
  const bool newer =
      map_ && map_->grid() == problem.map->grid() && map_->content().cost == problem.map->content().cost;
  const auto changed = newer ? changedCells(*map_, *problem.map) : std::nullopt;
  if (!newer) {
    refine_.clear();
    pooled_ = pooled(*problem.map, kFactor, problem.threads, stop);
  } else if (changed) {
    const maps::Grid& grid = problem.map->grid();
    refine_.forget({grid.centre(changed->first), grid.centre(changed->last)});
    pooled_ = repooled(*pooled_, *problem.map, kFactor, *changed);
  }
  map_ = pooled_ ? problem.map : nullptr;
  return pooled_ != nullptr;
}

Polyline TubePlanner::guideOver(const std::shared_ptr<const costmap::CostGrid>& coarse, const Problem& leg) {
  const MotionCost cost(coarse);
  const auto from = standingPlace(cost, leg.start), to = standingPlace(cost, leg.goal);
  if (!from || !to) return {};
  Problem rough = leg;
  rough.map = coarse;
  rough.start = *from;
  rough.goal = *to;
  rough.goal_tolerance_m = 0.0;
  rough.via.clear();
  rough.prove = false;
  const Plan plan = coarse_.plan(rough);
  if (plan.status != RouteStatus::Found) return {};
  Polyline along{leg.start};
  append(along, plan.points);
  append(along, {leg.goal});
  return along;
}

}  // namespace talus::planner
