#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

Plan FieldPlanner::plan(const Problem& problem) {
  if (!problem.map) throw std::invalid_argument("FieldPlanner: no map");
  const StopCheck stop(problem.watch, problem.time_limit_s);
  return planByLegs(problem, [&](const Problem& leg) {
    return planStage(leg, {leg.start, leg.goal, leg.goal_tolerance_m}, stop);
  });
}

// Units for this map: coarser on huge maps, so that sums along a route fit in 32 bits.
EdgeUnits FieldPlanner::unitsFor(const costmap::CostGrid& map) {
  const double side = map.grid().width + map.grid().height;
  return {map.cost(), map.grid().resolution_m, std::max(1.0, side / 16384.0)};
}

bool FieldPlanner::prepareEdges(const Problem& problem, const StopCheck& stop) {
  if (edges_ && (edges_->mapPointer() == problem.map || repairTo(problem))) return true;
  field_.reset();
  edges_.reset();
  refine_.clear();
  auto edges = std::make_shared<EdgeLayer>(problem.map, unitsFor(*problem.map), problem.threads, stop);
  if (!edges->complete()) return false;
  edges_ = std::move(edges);
  return true;
}

// Updates edges and field to a newer version of the map. Returns false for an unrelated map.
bool FieldPlanner::repairTo(const Problem& problem) {
  const costmap::CostGrid &old = edges_->map(), &newer = *problem.map;
  if (!(old.grid() == newer.grid())) return false;
  const EdgeUnits units = unitsFor(newer);
  if (!units.extends(edges_->units())) return false;
  const auto changed = changedCells(old, newer);
  edges_->update(problem.map, units, changed.value_or(CellBox{}));
  if (changed) refine_.forget({newer.grid().centre(changed->first), newer.grid().centre(changed->last)});
  if (field_ && fieldGoals(MotionCost(problem.map), field_goal_, field_tolerance_m_) != field_goals_)
    field_.reset();
  if (field_ && changed) field_->repair(*changed);
  return true;
}

bool FieldPlanner::prepareField(const MotionCost& cost, const Stage& stage) {
  if (field_ && field_goal_ == stage.to && field_tolerance_m_ == stage.tolerance_m) return true;
  field_goals_ = fieldGoals(cost, stage.to, stage.tolerance_m);
  field_.reset();
  if (field_goals_.empty()) return false;
  field_.emplace(edges_, field_goals_);
  field_goal_ = stage.to;
  field_tolerance_m_ = stage.tolerance_m;
  return true;
}

Plan FieldPlanner::planStage(const Problem& problem, const Stage& stage, const StopCheck& stop) {
  const MotionCost cost(problem.map);
  const bool from_there = cost.allowed(stage.from), to_there = mayEnd(cost, stage.to, stage.tolerance_m);
  if (!from_there || !to_there) return misplaced(problem, stage, from_there, to_there, stop);
  if (!prepareEdges(problem, stop)) return cancelledPlan(stop);
  Polyline rough;
  if (prepareField(cost, stage)) rough = gridRoute(cost, *field_, {stage.from, stage.to}, stop);
  if (rough.empty()) {
    Plan beyond = beyondTheGrid(problem, stage, stop);
    if (beyond.status != RouteStatus::Found) return beyond;
    rough = std::move(beyond.points);
  }
  Plan plan = finished(problem, stage, std::move(rough), stop);
  if (problem.prove) tryOverPoints(problem, stage, stop, plan);
  return withoutTipping(std::move(plan));
}

HeadingSets& FieldPlanner::headingsOf(const Problem& problem) {
  if (headings_map_ != problem.map) {
    headings_ = std::make_unique<HeadingSets>(problem.map->cost());
    headings_map_ = problem.map;
  }
  return *headings_;
}

// Result for an invalid start or goal. If the other end is valid, the message names the nearest cell
// connected to that end.
Plan FieldPlanner::misplaced(const Problem& problem, const Stage& stage, bool from_there, bool to_there,
                             const StopCheck& stop) {
  PlaceDiagnostics help{.hazards = problem.hazards};
  std::optional<Reach> other;
  if (from_there != to_there && problem.map->grid().size() <= kTriedCells) {
    HeadingSets& headings = headingsOf(problem);
    if (from_there)
      other.emplace(*problem.map, headings, Reach::Sense::From, stage.from, 0.0, stop);
    else
      other.emplace(*problem.map, headings, Reach::Sense::To, stage.to, stage.tolerance_m, stop);
    if (other->complete()) help.joined = [&other](maps::Cell cell) { return other->holds(cell); };
  }
  if (!from_there)
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*problem.map, "start", stage.from, help));
  return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*problem.map, "goal", stage.to, help));
}

// Plans with arbitrary headings if the eight grid headings find no route. Returns a rough route, a proof that
// no route exists, or neither.
Plan FieldPlanner::beyondTheGrid(const Problem& problem, const Stage& stage, const StopCheck& stop) {
  if (stop()) return cancelledPlan(stop);
  const Segment places{stage.from, stage.to};
  HeadingSets& headings = headingsOf(problem);
  // A start or goal in a small pocket is proven to be one before any search on the whole map.
  const std::size_t pocket = problem.map->grid().size() / 64;
  std::optional<Reach> reach(std::in_place, *problem.map, headings, Reach::Sense::From, stage.from, 0.0, stop,
                             nullptr, pocket);
  Reach back(*problem.map, headings, Reach::Sense::To, stage.to, stage.tolerance_m, stop, nullptr, pocket);
  const bool closed = (reach->complete() && !reach->reaches(stage.to, stage.tolerance_m)) ||
                      (back.complete() && !back.reaches(stage.from, 0.0));
  Plan found = failedPlan(RouteStatus::Found, {});
  const auto search = [&](bool more) {
    bound_.prepare(problem.map, stage.to, stage.tolerance_m, stop);
    found.points = overPoints(problem, stage, kInfinity, stop, more);
    return !found.points.empty();
  };
  if (!closed && search(false)) return found;
  if (!reach->complete()) reach.emplace(*problem.map, headings, Reach::Sense::From, stage.from, 0.0, stop);
  if (!reach->complete()) return cancelledPlan(stop);
  if (!reach->reaches(stage.to, stage.tolerance_m) ||
      !Reach(*problem.map, headings, Reach::Sense::To, stage.to, stage.tolerance_m, stop)
           .reaches(stage.from, 0.0)) {
    if (stop()) return cancelledPlan(stop);
    const Obstruction why =
        obstructionBetween(*problem.map, headings, *reach, places, stage.tolerance_m, problem.hazards, stop);
    Plan none = failedPlan(RouteStatus::NoRoute, text(why, places));
    none.obstruction = why;
    return none;
  }
  // Nothing separates the places: more points of the cells may find the route.
  if (search(true)) return found;
  if (stop()) return cancelledPlan(stop);
  return failedPlan(
      RouteStatus::NoneFound,
      "no route found, nor a proof that there is none: the ways left allow only single headings; "
      "increase the goal tolerance, add a via point, or choose another goal");
}

Polyline FieldPlanner::refined(const Problem& problem, const Stage& stage, Polyline rough,
                               const StopCheck& stop) {
  const MotionCost cost(problem.map);
  const auto cut = [&](Polyline way) {
    return withoutCloseVertices(
        cost, cutWithin(refine_(cost, std::move(way), problem.threads, stop), stage.to, stage.tolerance_m));
  };
  Polyline points = cut(std::move(rough));
  if (!(stage.tolerance_m > 0.0)) return points;
  // Refinement keeps the ends. The entry into the tolerance is chosen afterwards, and the route to the new
  // end is refined once more.
  Polyline ended = withSettledEnd(cost, points, stage.to, stage.tolerance_m);
  if (ended.back() == points.back()) return points;
  Polyline again = cut(ended);
  return cost.along(again) <= cost.along(ended) ? again : ended;
}

// Searches the points of cells in the region of the lower bound, and settles the vertices of both routes.
void FieldPlanner::tryOverPoints(const Problem& problem, const Stage& stage, const StopCheck& stop,
                                 Plan& plan) {
  const AddedTime proof(plan.proof_s);
  if (stop() || plan.lower_bound_J >= (1.0 - std::max(kProven, problem.gap)) * plan.cost_J) return;
  const MotionCost cost(problem.map);
  const auto take = [&](Polyline points) {
    const double cost_J = cost.along(points);
    if (points.size() < 2 || !(cost_J < plan.cost_J)) return;
    plan.points = std::move(points);
    plan.cost_J = cost_J;
  };
  Polyline way = overPoints(problem, stage, kSettled * plan.cost_J, stop);
  if (way.size() > 1) take(refined(problem, stage, withSettledVertices(cost, std::move(way), stop), stop));
  take(withoutCloseVertices(cost, withSettledVertices(cost, plan.points, stop)));
  plan.lower_bound_J = std::min(plan.lower_bound_J, plan.cost_J);
}

Polyline FieldPlanner::overPoints(const Problem& problem, const Stage& stage, double most_J,
                                  const StopCheck& stop, bool more) const {
  return pointRoute(
      MotionCost(problem.map), {stage.from, stage.to}, stage.tolerance_m, most_J, stop,
      [this](maps::Point at) { return bound_.toGoal_J(at); }, more);
}

Plan FieldPlanner::finished(const Problem& problem, const Stage& stage, Polyline rough,
                            const StopCheck& stop) {
  const MotionCost cost(problem.map);
  Plan plan = failedPlan(RouteStatus::Found, {});
  plan.points = refined(problem, stage, std::move(rough), stop);
  plan.cost_J = cost.along(plan.points);
  if (problem.prove) {
    const AddedTime proof(plan.proof_s);
    field_.reset(), edges_.reset();  // memory for the proof, which takes longer than to compute both again
    plan.lower_bound_J = std::min(plan.cost_J, bound_(problem.map, {stage.from, stage.to}, stage.tolerance_m,
                                                      stop, plan.cost_J, problem.gap));
  }
  return plan;
}

}  // namespace talus::planner
