#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/field/grid_route.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/refine/vertices.hpp>
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

// The guide is refined roughly: it need not be more accurate than the tube's width.
TubePlanner::TubePlanner() : coarse_(RefineOptions{.reach_cells = 0, .detour_cells = 0}) {}

Plan TubePlanner::planAlong(const Problem& problem, const Polyline& guide) {
  const StopCheck stop(problem.watch, problem.time_limit_s);
  const MotionCost cost(problem.map);
  if (!cost.allowed(problem.start))
    return failedPlan(RouteStatus::StartInvalid, invalidPlace(*problem.map, "start", problem.start));
  if (!mayEnd(cost, problem.goal, problem.goal_tolerance_m))
    return failedPlan(RouteStatus::GoalInvalid, invalidPlace(*problem.map, "goal", problem.goal));
  Polyline way = tubeRoute(problem, guide, {}, stop);
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

namespace {

using costmap::CostTile;

constexpr int kSide = CostTile::kSide;
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

// Clamps the guide to the map: cells of the overview may extend beyond the map.
Polyline onto(const maps::Grid& grid, Polyline guide) {
  const double half_m = 0.5 * grid.resolution_m;
  const maps::Point low{grid.south_west.x_m + half_m, grid.south_west.y_m + half_m};
  for (maps::Point& p : guide)
    p = {std::clamp(p.x_m, low.x_m, low.x_m + (grid.width - 1) * grid.resolution_m),
         std::clamp(p.y_m, low.y_m, low.y_m + (grid.height - 1) * grid.resolution_m)};
  return guide;
}

// Plans one leg along the overview's route in a window, then in a wider window if the first contains no
// route.
Plan planLeg(Problem& leg, WindowedMap& map, TubePlanner& tube) {
  const auto guide = onto(map.grid(), tube.guideOver(map.overview(), leg));
  if (guide.empty()) {
    Plan none;
    none.reason =
        "no route found on the overview; plan on a part with --window, or on the whole map with "
        "--whole-field";
    return none;
  }
  Plan plan;
  for (const double margin_cells : {128.0, 512.0}) {
    leg.map = map.around(guide, margin_cells, leg.watch);
    plan = tube.planAlong(leg, guide);
    if (plan.status != RouteStatus::NoneFound) break;
  }
  return plan;
}

}  // namespace

Plan planInWindows(Problem& problem, WindowedMap& map) {
  TubePlanner tube;
  Plan whole = planByLegs(problem, [&](const Problem& asked) {
    Problem leg = asked;
    Plan plan = planLeg(leg, map, tube);
    problem.map = leg.map;
    return plan;
  });
  whole.interrupted = problem.watch.stopped();
  return whole;
}

}  // namespace talus::planner
