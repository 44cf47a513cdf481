#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/field/pooled_grid.hpp>
#include <talus/planner/field/remedy.hpp>
#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {
namespace {

using costmap::CostGrid;
using costmap::CostTile;
using maps::Cell;
using maps::Point;
using MapPointer = std::shared_ptr<const CostGrid>;

const std::shared_ptr<const CostTile>& unknownTile() {
  static const auto tile = std::make_shared<const CostTile>();
  return tile;
}

// Range of tiles (column, row) within a margin around a line.
CellBox tilesAround(const maps::Grid& grid, const Polyline& line, double margin_cells) {
  Point low = line.front(), high = low;
  for (const Point p : line) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  const auto tile = [&](double at_m, double origin_m, double margin, int count) {
    const double cell = (at_m - origin_m) / grid.resolution_m + margin;
    return static_cast<int>(std::clamp(cell, 0.0, count - 1.0)) / CostTile::kSide;
  };
  return {{tile(low.x_m, grid.south_west.x_m, -margin_cells, grid.width),
           tile(low.y_m, grid.south_west.y_m, -margin_cells, grid.height)},
          {tile(high.x_m, grid.south_west.x_m, margin_cells, grid.width),
           tile(high.y_m, grid.south_west.y_m, margin_cells, grid.height)}};
}

// Box of map tiles around a section; tiles outside the tube are unknown.
class Window {
 public:
  Window(const CostGrid& map, const Polyline& guide, double margin_cells)
      : whole_(map), tiles_(tilesAround(map.grid(), guide, margin_cells)) {
    constexpr int kSide = CostTile::kSide;
    const maps::Grid& grid = map.grid();
    content_.tiles = costmap::TileTable(static_cast<std::size_t>(columns() * rows()), unknownTile());
    content_.cost = map.content().cost;
    content_.version = map.version();
    content_.grid = {std::min((tiles_.last.column + 1) * kSide, grid.width) - tiles_.first.column * kSide,
                     std::min((tiles_.last.row + 1) * kSide, grid.height) - tiles_.first.row * kSide,
                     grid.resolution_m,
                     {grid.south_west.x_m + tiles_.first.column * kSide * grid.resolution_m,
                      grid.south_west.y_m + tiles_.first.row * kSide * grid.resolution_m}};
    for (const Point p : subdivided(guide, kSide * grid.resolution_m / 4)) keepAround(p, margin_cells);
    map_ = std::make_shared<CostGrid>(content_);
  }

  const MapPointer& map() const noexcept { return map_; }

  // Returns true if a route passes within 2.5 cells of a tile that was left out.
  bool touchesWall(const Polyline& way) const {
    const double clear_m = 2.5 * content_.grid.resolution_m;
    return std::any_of(way.begin(), way.end(), [&](Point p) {
      for (const double dx : {-clear_m, clear_m})
        for (const double dy : {-clear_m, clear_m})
          if (leftOut({p.x_m + dx, p.y_m + dy})) return true;
      return false;
    });
  }

 private:
  int columns() const noexcept { return tiles_.last.column - tiles_.first.column + 1; }
  int rows() const noexcept { return tiles_.last.row - tiles_.first.row + 1; }

  void keepAround(Point p, double margin_cells) {
    const CellBox near = tilesAround(whole_.grid(), {p}, margin_cells);
    for (int row = near.first.row; row <= near.last.row; ++row)
      for (int column = near.first.column; column <= near.last.column; ++column)
        content_.tiles.set(
            static_cast<std::size_t>((row - tiles_.first.row) * columns() + column - tiles_.first.column),
            whole_.content().tiles[static_cast<std::size_t>(row * whole_.tileColumns() + column)]);
  }

  bool leftOut(Point p) const {
    if (!whole_.grid().cellAt(p)) return false;  // outside the whole map
    const auto cell = content_.grid.cellAt(p);
    if (!cell) return true;
    const auto tile =
        static_cast<std::size_t>(cell->row / CostTile::kSide * columns() + cell->column / CostTile::kSide);
    return content_.tiles[tile] == unknownTile();
  }

  const CostGrid& whole_;
  CellBox tiles_;
  CostGrid::Content content_;
  MapPointer map_;
};

struct TubeSection {
  Polyline guide;  // from place to place
  double tolerance_m = 0.0;
  Polyline way{};  // empty: no route found
};

class Tube {
 public:
  Tube(const Problem& problem, const TubeOptions& options, const StopCheck& stop)
      : problem_(problem), options_(options), stop_(stop), cell_m_(problem.map->grid().resolution_m) {}

  std::vector<TubeSection> cut(const Polyline& guide) const;
  bool searchAll(std::vector<TubeSection>& sections) const;
  Polyline joined(const std::vector<TubeSection>& sections) const;

 private:
  Polyline search(const TubeSection& section) const;
  Polyline searchWithin(const Window& window, const TubeSection& section) const;
  std::optional<Point> placeNear(const MotionCost& cost, Point p) const;

  const Problem& problem_;
  TubeOptions options_;
  const StopCheck& stop_;
  double cell_m_;
};

// Nearest traversable cell centre within the margin.
std::optional<Point> Tube::placeNear(const MotionCost& cost, Point p) const {
  const maps::Grid& grid = cost.map().grid();
  const auto own = grid.cellAt(p);
  if (!own) return std::nullopt;
  for (int ring = 0; ring <= static_cast<int>(options_.margin_cells); ++ring)
    for (int row = own->row - ring; row <= own->row + ring; ++row) {
      const int step = std::abs(row - own->row) == ring || ring == 0 ? 1 : 2 * ring;
      for (int column = own->column - ring; column <= own->column + ring; column += step)
        if (grid.contains({column, row}) && cost.allowed(grid.centre({column, row})))
          return grid.centre({column, row});
    }
  return std::nullopt;
}

// Sections between places on the guide. The last section ends at the goal.
std::vector<TubeSection> Tube::cut(const Polyline& guide) const {
  const MotionCost cost(problem_.map);
  std::vector<TubeSection> sections;
  Polyline at = {guide.front()};
  auto pieces = cutFromEnd(guide, options_.leg_cells * cell_m_, options_.leg_cells * cell_m_);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const bool last = k + 1 == pieces.size();
    pieces[k].erase(pieces[k].begin());
    const auto place = last ? std::optional(guide.back()) : placeNear(cost, pieces[k].back());
    if (place) pieces[k].back() = *place;
    append(at, pieces[k]);
    if (!place) continue;  // no traversable cell: extends the section
    sections.push_back({at, last ? problem_.goal_tolerance_m : 0.0});
    at = {*place};
  }
  return sections;
}

Polyline Tube::searchWithin(const Window& window, const TubeSection& section) const {
  const MotionCost cost(window.map());
  const Segment places{section.guide.front(), section.guide.back()};
  const double longest = window.map()->grid().width + window.map()->grid().height;
  const EdgeUnits units(window.map()->cost(), cell_m_, std::max(1.0, longest / 16384.0));
  const auto edges = std::make_shared<EdgeLayer>(window.map(), units, 1, stop_);
  const auto goals = fieldGoals(cost, places.to, section.tolerance_m);
  if (!edges->complete() || goals.empty()) return {};
  CostToGo field(edges, goals);
  return gridRoute(cost, field, places, stop_);
}

Polyline Tube::search(const TubeSection& section) const {
  Polyline way;
  double margin = options_.margin_cells;
  for (int k = 0; k <= options_.widenings && !stop_(); ++k, margin *= 2) {
    const Window window(*problem_.map, section.guide, margin);
    way = searchWithin(window, section);
    if (!way.empty() && !window.touchesWall(way)) return way;
  }
  return way;
}

// Searches every section. A section without a route is joined with a neighbour. Returns false if a single
// section is left without a route, or when stopped.
bool Tube::searchAll(std::vector<TubeSection>& sections) const {
  for (;;) {
    parallelFor(sections.size(), problem_.threads, [&](std::size_t k) {
      if (sections[k].way.empty()) sections[k].way = search(sections[k]);
    });
    const auto lost = std::find_if(sections.begin(), sections.end(),
                                   [](const TubeSection& section) { return section.way.empty(); });
    if (lost == sections.end()) return true;
    if (sections.size() == 1 || stop_()) return false;
    const auto first = lost + 1 == sections.end() ? lost - 1 : lost;
    append(first->guide, (first + 1)->guide);
    first->tolerance_m = (first + 1)->tolerance_m;
    first->way.clear();
    sections.erase(first + 1);
  }
}

// Joins the sections' routes and searches again around the joints.
Polyline Tube::joined(const std::vector<TubeSection>& sections) const {
  const MotionCost cost(problem_.map);
  std::vector<Polyline> ways;
  for (const TubeSection& section : sections) ways.push_back(section.way);
  const auto again = [&](const Polyline& joint) {
    if (joint.size() < 2 || length_m(joint) < 2 * cell_m_) return joint;
    const Polyline way = search({joint, 0.0});
    return !way.empty() && way.back() == joint.back() && cost.along(way) < cost.along(joint) ? way : joint;
  };
  RefinementCache memo;
  const WindowCut cut{options_.leg_cells * cell_m_, options_.overlap_cells * cell_m_, 0.0};
  return joinWindows(ways, cut, again, memo, problem_.threads, stop_);
}

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

Polyline tubeRoute(const Problem& problem, const Polyline& guide, const TubeOptions& options,
                   const StopCheck& stop) {
  if (guide.size() < 2) return {problem.start};  // nothing to drive
  const Tube tube(problem, options, stop);
  auto sections = tube.cut(guide);
  if (!tube.searchAll(sections)) return {};
  return tube.joined(sections);
}

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
