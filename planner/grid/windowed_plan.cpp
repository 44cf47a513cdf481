#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/grid/windowed_plan.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

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
