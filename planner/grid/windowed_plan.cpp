#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

namespace {

using costmap::CostGrid;
using costmap::CostTile;
using maps::Cell;
using maps::Point;
using MapPointer = std::shared_ptr<const CostGrid>;

constexpr int kSide = CostTile::kSide;

// Range of tiles (column, row) within a margin around a line.
CellBox tilesAround(const maps::Grid& grid, const Polyline& line, double margin_cells) {
  Point low = line.front(), high = low;
  for (const Point p : line) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  const auto tile = [&](double at_m, double origin_m, double margin, int count) {
    const double cell = (at_m - origin_m) / grid.resolution_m + margin;
    return static_cast<int>(std::clamp(cell, 0.0, count - 1.0)) / kSide;
  };
  return {{tile(low.x_m, grid.south_west.x_m, -margin_cells, grid.width),
           tile(low.y_m, grid.south_west.y_m, -margin_cells, grid.height)},
          {tile(high.x_m, grid.south_west.x_m, margin_cells, grid.width),
           tile(high.y_m, grid.south_west.y_m, margin_cells, grid.height)}};
}

// The map of the tiles in the box around a line.
MapPointer boxAround(const CostGrid& map, const Polyline& line, double margin_cells) {
  const CellBox tiles = tilesAround(map.grid(), line, margin_cells);
  const maps::Grid& grid = map.grid();
  CostGrid::Content content = map.content();
  content.grid = {std::min((tiles.last.column + 1) * kSide, grid.width) - tiles.first.column * kSide,
                  std::min((tiles.last.row + 1) * kSide, grid.height) - tiles.first.row * kSide,
                  grid.resolution_m,
                  {grid.south_west.x_m + tiles.first.column * kSide * grid.resolution_m,
                   grid.south_west.y_m + tiles.first.row * kSide * grid.resolution_m}};
  content.tiles = costmap::TileTable(static_cast<std::size_t>(tiles.width() * tiles.height()),
                                     std::make_shared<const CostTile>());
  std::size_t to = 0;
  for (int row = tiles.first.row; row <= tiles.last.row; ++row)
    for (int column = tiles.first.column; column <= tiles.last.column; ++column)
      content.tiles.set(to++,
                        map.content().tiles[static_cast<std::size_t>(row * map.tileColumns() + column)]);
  return std::make_shared<CostGrid>(std::move(content));
}

// The place itself, or a cell centre at most `far_cells` cells away, with an allowed heading.
std::optional<Point> standingPlace(const MotionCost& cost, Point p, int far_cells) {
  if (cost.allowed(p)) return p;
  const maps::Grid& grid = cost.map().grid();
  const auto own = grid.cellAt(p);
  if (!own) return std::nullopt;
  for (int ring = 0; ring <= far_cells; ++ring)
    for (int row = own->row - ring; row <= own->row + ring; ++row) {
      const int step = std::abs(row - own->row) == ring || ring == 0 ? 1 : 2 * ring;
      for (int column = own->column - ring; column <= own->column + ring; column += step)
        if (grid.contains({column, row}) && cost.allowed(grid.centre({column, row})))
          return grid.centre({column, row});
    }
  return std::nullopt;
}

constexpr double kPart = 384.0;  // [cells] length of the parts of a guide that are planned separately
constexpr int kJoint = 48;       // [cells] distance from the guide within which parts meet

// A part of a route: its guide, and the plan between the ends of the guide.
struct Part {
  Polyline guide;
  double tolerance_m = 0.0;
  std::optional<Plan> plan{};

  bool found() const { return plan && plan->status == RouteStatus::Found; }
};

// Plans the parts that have no plan, each in the box around its guide.
void planParts(const Problem& problem, double margin_cells, std::vector<Part>& parts, const StopCheck& stop) {
  parallelFor(parts.size(), problem.threads, [&](std::size_t k) {
    Part& part = parts[k];
    if (part.plan || stop()) return;
    Problem own = problem;
    own.map = boxAround(*problem.map, part.guide, margin_cells);
    own.start = part.guide.front();
    own.goal = part.guide.back();
    own.goal_tolerance_m = part.tolerance_m;
    own.via.clear();
    own.prove = false;
    own.threads = 1;
    part.plan = FieldPlanner().plan(own);
  });
}

// Parts between places on the guide. The last part ends at the goal.
std::vector<Part> partsOf(const Problem& problem, const Polyline& guide) {
  const MotionCost cost(problem.map);
  const double part_m = kPart * problem.map->grid().resolution_m;
  std::vector<Part> parts;
  Polyline at = {guide.front()};
  auto pieces = cutFromEnd(guide, part_m, part_m);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const bool last = k + 1 == pieces.size();
    pieces[k].erase(pieces[k].begin());
    const auto place = last ? std::optional(guide.back()) : standingPlace(cost, pieces[k].back(), kJoint);
    if (place) pieces[k].back() = *place;
    append(at, pieces[k]);
    if (!place) continue;  // no traversable cell: extends the part
    parts.push_back({at, last ? problem.goal_tolerance_m : 0.0});
    at = {*place};
  }
  return parts;
}

// Returns the route along a guide, planned in parts; a part without a route is joined with a neighbour. The
// stretches from the middle of each part to the middle of the next are then planned again. Empty if a single
// part is left without a route, or after a stop.
Polyline alongGuide(const Problem& problem, const Polyline& guide, double margin_cells,
                    const StopCheck& stop) {
  std::vector<Part> parts = partsOf(problem, guide);
  for (;;) {
    planParts(problem, margin_cells, parts, stop);
    const auto lost = std::ranges::find_if_not(parts, &Part::found);
    if (lost == parts.end()) break;
    if (parts.size() == 1 || stop()) return {};
    const auto first = lost + 1 == parts.end() ? lost - 1 : lost;
    append(first->guide, (first + 1)->guide);
    first->tolerance_m = (first + 1)->tolerance_m;
    first->plan.reset();
    parts.erase(first + 1);
  }
  // Turns on the rim of a box, and where parts meet, may touch a cell that does not permit them.
  const MotionCost cost(problem.map);
  Polyline whole{guide.front()};
  for (const Part& part : parts) append(whole, part.plan->points);
  whole = offSides(cost, std::move(whole));
  if (!(cost.along(whole) < kInfinity)) return {};
  const double part_m = kPart * problem.map->grid().resolution_m;
  std::vector<Part> across;
  for (Polyline& piece : cutFromEnd(whole, part_m, 0.5 * part_m)) across.push_back({std::move(piece)});
  planParts(problem, margin_cells, across, stop);
  Polyline again{whole.front()};
  for (const Part& part : across)
    append(again,
           part.found() && part.plan->cost_J < cost.along(part.guide) ? part.plan->points : part.guide);
  again = offSides(cost, std::move(again));
  return cost.along(again) < cost.along(whole) ? again : whole;
}

// Plan near the given guide; its lower bound is that of the straight line.
Plan planAlong(const Problem& leg, const Polyline& guide, double margin_cells) {
  const StopCheck stop(leg.watch, leg.time_limit_s);
  const MotionCost cost(leg.map);
  if (!cost.allowed(leg.start))
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*leg.map, "start", leg.start));
  if (!mayEnd(cost, leg.goal, leg.goal_tolerance_m))
    return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*leg.map, "goal", leg.goal));
  Plan plan = failedPlan(RouteStatus::Found, {});
  plan.points = guide.size() < 2 ? Polyline{leg.start} : alongGuide(leg, guide, margin_cells, stop);
  if (stop()) return cancelledPlan(stop);
  if (plan.points.empty())
    return failedPlan(
        RouteStatus::NoneFound,
        "no route found near the route over the overview; read a part with --window, or the whole map");
  plan.points = withoutCloseVertices(cost, cutWithin(std::move(plan.points), leg.goal, leg.goal_tolerance_m));
  plan.cost_J = cost.along(plan.points);
  const auto proven_J = [&] {
    const AddedTime proof(plan.proof_s);
    return straightBoundOver_J(*leg.map, {leg.start, leg.goal}, leg.goal_tolerance_m, plan.cost_J, stop);
  };
  plan.lower_bound_J = std::min(plan.cost_J, leg.prove ? proven_J() : 0.0);
  return withoutTipping(std::move(plan));
}

// Returns the guide for a leg: the route from start to goal on the overview, clamped to the map, because cells
// of the overview may extend beyond it. Empty if the overview has no traversable cell near start or goal, or no
// route between both.
Polyline guideOver(const WindowedMap& map, const Problem& leg) {
  constexpr int kFar = 8;
  const MotionCost cost(map.overview());
  const auto from = standingPlace(cost, leg.start, kFar), to = standingPlace(cost, leg.goal, kFar);
  if (!from || !to) return {};
  Problem rough = leg;
  rough.map = map.overview();
  rough.start = *from;
  rough.goal = *to;
  rough.goal_tolerance_m = 0.0;
  rough.via.clear();
  rough.prove = false;
  const Plan plan = FieldPlanner().plan(rough);
  if (plan.status != RouteStatus::Found) return {};
  Polyline along{leg.start};
  append(along, plan.points);
  append(along, {leg.goal});
  const maps::Grid& grid = map.grid();
  const double half_m = 0.5 * grid.resolution_m;
  const Point low{grid.south_west.x_m + half_m, grid.south_west.y_m + half_m};
  for (Point& p : along)
    p = {std::clamp(p.x_m, low.x_m, low.x_m + (grid.width - 1) * grid.resolution_m),
         std::clamp(p.y_m, low.y_m, low.y_m + (grid.height - 1) * grid.resolution_m)};
  return along;
}

constexpr int kBlock = 8;  // tiles per side of a block built at once

int tilesAcross(int cells) {
  return (cells + kSide - 1) / kSide;
}

// Sub-grid of the cells from `first` to `last`.
maps::Grid part(const maps::Grid& whole, maps::Cell first, maps::Cell last) {
  return {.width = last.column - first.column + 1,
          .height = last.row - first.row + 1,
          .resolution_m = whole.resolution_m,
          .south_west = {whole.south_west.x_m + first.column * whole.resolution_m,
                         whole.south_west.y_m + first.row * whole.resolution_m}};
}

MapBox boxOf(const maps::Grid& grid) {
  return {.low = grid.south_west,
          .high = {grid.south_west.x_m + grid.width * grid.resolution_m,
                   grid.south_west.y_m + grid.height * grid.resolution_m}};
}

void requireCells(const maps::Grid& built, const maps::Grid& asked) {
  const double near_m = 0.01 * asked.resolution_m;
  const bool same = built.width == asked.width && built.height == asked.height &&
                    std::abs(built.south_west.x_m - asked.south_west.x_m) < near_m &&
                    std::abs(built.south_west.y_m - asked.south_west.y_m) < near_m &&
                    std::abs(built.resolution_m - asked.resolution_m) * built.width < near_m;
  if (!same) throw std::invalid_argument("WindowedMap: what was built is not the cells of the box");
}

}  // namespace

WindowedMap::WindowedMap(Parts parts) : parts_(std::move(parts)) {
  if (!parts_.overview) throw std::invalid_argument("WindowedMap: no overview");
  if (!parts_.build) throw std::invalid_argument("WindowedMap: no build");
  content_.grid = grid();
  content_.tiles = costmap::TileTable(static_cast<std::size_t>(tilesAcross(grid().width)) *
                                          static_cast<std::size_t>(tilesAcross(grid().height)),
                                      std::make_shared<const CostTile>());
  content_.version = 1;
  content_.cost = parts_.overview->content().cost;
}

std::size_t WindowedMap::cellsBuilt() const noexcept {
  return built_.size() * kSide * kSide;
}

std::set<WindowedMap::Tile> WindowedMap::missing(const Polyline& line, double margin_cells) const {
  std::set<Tile> tiles;
  for (const maps::Point p : subdivided(line, 0.25 * kSide * grid().resolution_m)) {
    const double column = (p.x_m - grid().south_west.x_m) / grid().resolution_m,
                 row = (p.y_m - grid().south_west.y_m) / grid().resolution_m;
    const auto tile = [](double cell, int count) {
      return static_cast<int>(std::clamp(cell, 0.0, count - 1.0)) / kSide;
    };
    for (int r = tile(row - margin_cells, grid().height); r <= tile(row + margin_cells, grid().height); ++r)
      for (int c = tile(column - margin_cells, grid().width); c <= tile(column + margin_cells, grid().width);
           ++c)
        if (!built_.contains({r, c})) tiles.insert({r, c});
  }
  return tiles;
}

// Copies tiles and their elevation from a map whose first cell is cell `first` of the whole map.
void WindowedMap::take(const costmap::TraversabilityMap& built, maps::Cell first,
                       const std::set<Tile>& tiles) {
  const auto version = built.published();
  const maps::Raster<float>& heights = built.elevation().elevation_m;
  content_.cost = version->content().cost;
  for (const auto& [row, column] : tiles) {
    const int r = row - first.row / kSide, c = column - first.column / kSide;
    content_.tiles.set(static_cast<std::size_t>(row * tilesAcross(grid().width) + column),
                       version->content().tiles[static_cast<std::size_t>(r * version->tileColumns() + c)]);
    const maps::Cell corner{c * kSide - 1, r * kSide - 1};
    maps::Raster<float> copy(
        {.width = kSide + 2,
         .height = kSide + 2,
         .resolution_m = grid().resolution_m,
         .south_west = {heights.grid().south_west.x_m + corner.column * grid().resolution_m,
                        heights.grid().south_west.y_m + corner.row * grid().resolution_m}},
        std::nanf(""));
    for (int y = 0; y < kSide + 2; ++y)
      for (int x = 0; x < kSide + 2; ++x)
        if (const maps::Cell from{corner.column + x, corner.row + y}; heights.grid().contains(from))
          copy[{x, y}] = heights[from];
    built_.emplace(Tile{row, column}, std::move(copy));
  }
}

// Builds the box around some tiles of one block, extended by one tile on every side (slopes and clearances
// depend on neighbouring cells), and copies the tiles.
void WindowedMap::build(const std::set<Tile>& tiles) {
  int row0 = tiles.begin()->first, row1 = row0, column0 = tiles.begin()->second, column1 = column0;
  for (const auto& [row, column] : tiles) {
    row0 = std::min(row0, row), row1 = std::max(row1, row);
    column0 = std::min(column0, column), column1 = std::max(column1, column);
  }
  const maps::Cell first{std::max(column0 - 1, 0) * kSide, std::max(row0 - 1, 0) * kSide};
  const maps::Cell last{std::min((column1 + 2) * kSide, grid().width) - 1,
                        std::min((row1 + 2) * kSide, grid().height) - 1};
  const maps::Grid cells = part(grid(), first, last);
  if (const auto made = parts_.build(boxOf(cells))) {
    requireCells(made->elevation().grid(), cells);
    take(*made, first, tiles);
  } else {
    for (const Tile& tile : tiles) built_.try_emplace(tile);  // stays unknown
  }
}

std::shared_ptr<const costmap::CostGrid> WindowedMap::around(const Polyline& line, double margin_cells,
                                                             const ProgressMonitor& watch) {
  std::map<Tile, std::set<Tile>> blocks;
  for (const Tile& tile : missing(line, margin_cells))
    blocks[{tile.first / kBlock, tile.second / kBlock}].insert(tile);
  for (const auto& [block, tiles] : blocks) {
    if (watch.stopped()) break;
    build(tiles);
  }
  return std::make_shared<const costmap::CostGrid>(content_);
}

std::optional<double> WindowedMap::elevation_m(maps::Point point) const {
  const auto cell = grid().cellAt(point);
  if (!cell) return std::nullopt;
  const auto tile = built_.find({cell->row / kSide, cell->column / kSide});
  if (tile == built_.end() || tile->second.empty()) return std::nullopt;
  return maps::elevationAt(tile->second, point);
}

namespace {

// Plans one leg along the overview's route in a window, then in a wider window if the first contains no
// route.
Plan planLeg(Problem& leg, WindowedMap& map) {
  const Polyline guide = guideOver(map, leg);
  if (guide.empty()) {
    Plan none;
    none.reason =
        "no route found on the overview; plan on a part with --window, or on the whole map with "
        "--in-memory";
    return none;
  }
  Plan plan;
  for (const double margin_cells : {128.0, 512.0}) {
    leg.map = map.around(guide, margin_cells, leg.watch);
    plan = planAlong(leg, guide, margin_cells);
    if (plan.status != RouteStatus::NoneFound) break;
  }
  return plan;
}

}  // namespace

Plan planInWindows(Problem& problem, WindowedMap& map) {
  Plan whole = planByLegs(problem, [&](const Problem& asked) {
    Problem leg = asked;
    Plan plan = planLeg(leg, map);
    problem.map = leg.map;
    return plan;
  });
  whole.interrupted = problem.watch.stopped();
  return whole;
}

}  // namespace talus::planner
