#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <planner/field_planner.hpp>
#include <planner/grid_links.hpp>
#include <planner/remedy.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

Plan ended(RouteStatus status, std::string reason) {
  Plan plan;
  plan.status = status;
  plan.reason = std::move(reason);
  return plan;
}

Plan stoppedBy(const StopCheck& stop) {
  if (stop.cancelled()) return ended(RouteStatus::Cancelled, "cancelled before a route was found");
  return ended(RouteStatus::TimedOut, "the time limit passed before a route was found; allow more time");
}

// The link through which the goal is reached cheapest; nothing when none reaches it.
const GridLink* bestLink(const std::vector<GridLink>& links, const CostToGo& field) {
  const GridLink* best = nullptr;
  double best_J = std::numeric_limits<double>::infinity();
  for (const GridLink& link : links) {
    const auto rest_J = field.cost_J(link.cell);
    if (!rest_J || link.cost_J + *rest_J >= best_J) continue;
    best_J = link.cost_J + *rest_J;
    best = &link;
  }
  return best;
}

void add(std::vector<Point>& points, Point p) {
  if (points.empty() || !(points.back() == p)) points.push_back(p);
}

// The route along the centres of the cells, from place to place where the last cell joins the goal.
std::vector<Point> throughCentres(const MotionCost& cost, Point from, const std::vector<Cell>& cells,
                                  Point to) {
  std::vector<Point> points{from};
  for (const Cell cell : cells) add(points, cost.map().grid().centre(cell));
  if (std::isfinite(cost({points.back(), to}))) add(points, to);
  return points;
}

// The smallest box around all cells that differ; nothing when none does. Tiles that both versions share are
// not looked at.
std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer) {
  constexpr int kSide = costmap::CostTile::kSide;
  const maps::Grid& grid = old.grid();
  CellBox box{{grid.width, grid.height}, {-1, -1}};
  for (std::size_t t = 0; t < old.content().tiles.size(); ++t) {
    if (old.content().tiles[t] == newer.content().tiles[t]) continue;
    const int row0 = static_cast<int>(t) / old.tileColumns() * kSide,
              column0 = static_cast<int>(t) % old.tileColumns() * kSide;
    for (int row = row0; row < std::min(row0 + kSide, grid.height); ++row)
      for (int column = column0; column < std::min(column0 + kSide, grid.width); ++column) {
        if (old.at({column, row}) == newer.at({column, row})) continue;
        box.first = {std::min(box.first.column, column), std::min(box.first.row, row)};
        box.last = {std::max(box.last.column, column), std::max(box.last.row, row)};
      }
  }
  if (box.last.column < 0) return std::nullopt;
  return box;
}

}  // namespace

Plan FieldPlanner::plan(const Problem& problem) {
  if (!problem.map) throw std::invalid_argument("FieldPlanner: no map");
  const StopCheck stop(problem.watch, problem.time_limit_s);
  std::vector<Point> stops = problem.via;
  stops.push_back(problem.goal);
  Plan whole{RouteStatus::Found, {}, {problem.start}, 0.0, 0.0};
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const bool last = i + 1 == stops.size();
    const Leg leg{whole.points.back(), stops[i], last ? problem.goal_tolerance_m : 0.0};
    Plan part = planLeg(problem, leg, stop);
    if (part.status != RouteStatus::Found) return part;
    for (const Point p : part.points) add(whole.points, p);
    whole.cost_J += part.cost_J;
    whole.lower_bound_J += part.lower_bound_J;
    problem.watch.report(static_cast<double>(i + 1) / static_cast<double>(stops.size()));
  }
  return whole;
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

// Moves edges and field on to a newer version of the map; false when it is another map altogether.
bool FieldPlanner::repairTo(const Problem& problem) {
  const costmap::CostGrid &old = edges_->map(), &newer = *problem.map;
  if (!(old.grid() == newer.grid())) return false;
  const EdgeUnits units = unitsFor(newer);
  if (!units.extends(edges_->units())) return false;
  const auto changed = changedCells(old, newer);
  edges_->update(problem.map, units, changed.value_or(CellBox{}));
  if (changed) refine_.forget({newer.grid().centre(changed->first), newer.grid().centre(changed->last)});
  if (!changed || !field_) return true;
  if (fieldGoals(MotionCost(problem.map), field_goal_, field_tolerance_m_) == field_goals_)
    field_->repair(*changed);
  else
    field_.reset();
  return true;
}

bool FieldPlanner::prepareField(const MotionCost& cost, const Leg& leg) {
  if (field_ && field_goal_ == leg.to && field_tolerance_m_ == leg.tolerance_m) return true;
  field_goals_ = fieldGoals(cost, leg.to, leg.tolerance_m);
  field_.reset();
  if (field_goals_.empty()) return false;
  field_.emplace(edges_, field_goals_);
  field_goal_ = leg.to;
  field_tolerance_m_ = leg.tolerance_m;
  return true;
}

Plan FieldPlanner::planLeg(const Problem& problem, const Leg& leg, const StopCheck& stop) {
  const MotionCost cost(problem.map);
  if (!cost.allowed(leg.from))
    return ended(RouteStatus::StartInvalid, invalidPlace(*problem.map, "start", leg.from));
  if (!prepareEdges(problem, stop)) return stoppedBy(stop);
  if (!prepareField(cost, leg))
    return ended(RouteStatus::GoalInvalid, invalidPlace(*problem.map, "goal", leg.to));
  const auto links = linksFrom(cost, leg.from);
  for (const GridLink& link : links)
    if (!field_->settle(link.cell, stop)) return stoppedBy(stop);
  const GridLink* link = bestLink(links, *field_);
  if (!link) return ended(RouteStatus::NoRoute, noWay(*edges_, leg.from, leg.to));
  const auto rough = throughCentres(cost, leg.from, field_->path(link->cell), leg.to);
  Plan plan{RouteStatus::Found, {}, refine_(cost, rough, problem.threads, stop), 0.0, 0.0};
  plan.cost_J = cost.along(plan.points);
  const Segment ends{leg.from, leg.to};
  const double bound_J = problem.prove ? bound_(problem.map, ends, leg.tolerance_m, stop)
                                       : straightBound_J(*problem.map, {leg.from, plan.points.back()});
  plan.lower_bound_J = std::min(plan.cost_J, bound_J);
  return plan;
}

}  // namespace talus::planner
