#include <algorithm>
#include <cmath>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/windowed_ground.hpp>
#include <talus/costmap/octomap_surface.hpp>
#include <talus/maps/gdal_dataset.hpp>

namespace talus::cli {
namespace {

using costmap::CostTile;

constexpr int kSide = CostTile::kSide;
constexpr int kBlock = 8;  // tiles to a side of what is read at once
constexpr double kOverviewCells = 2'000'000;
constexpr std::int64_t kPixelCache = 64 << 20;  // bytes

int tilesAcross(int cells) {
  return (cells + kSide - 1) / kSide;
}

GroundOptions asOverview(GroundOptions options, const maps::Grid& grid) {
  maps::limitPixelCache(kPixelCache);
  options.dem.read.overview =
      std::max(2, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(grid.size()) / kOverviewCells))));
  return options;
}

maps::ReadOptions readOptions(const GroundOptions& options) {
  maps::ReadOptions read = options.dem.read;
  if (!options.dem.window.empty()) read.window = maps::parseWindow(options.dem.window);
  return read;
}

// Cells first to last of the whole grid as a window in map metres.
maps::Window windowOf(const maps::Grid& grid, maps::Cell first, maps::Cell last) {
  const maps::Point low{grid.south_west.x_m + first.column * grid.resolution_m,
                        grid.south_west.y_m + first.row * grid.resolution_m},
      high{grid.south_west.x_m + (last.column + 1) * grid.resolution_m,
           grid.south_west.y_m + (last.row + 1) * grid.resolution_m};
  return {low, high};
}

}  // namespace

bool WindowedGround::needed(const GroundOptions& options, std::size_t cells) {
  if (!options.map_file.empty() || costmap::octomapType(options.dem.path)) return false;
  return maps::elevationGrid(options.dem.path, readOptions(options)).size() > cells;
}

WindowedGround::WindowedGround(const GroundOptions& options, const Context& context)
    : options_(options),
      context_(context),
      grid_(maps::elevationGrid(options.dem.path, readOptions(options))),
      overview_(readGround(asOverview(options, grid_), context)) {
  context_.quiet = true;  // said for the overview already
  content_.grid = grid_;
  content_.tiles = costmap::TileTable(static_cast<std::size_t>(tilesAcross(grid_.width)) *
                                          static_cast<std::size_t>(tilesAcross(grid_.height)),
                                      std::make_shared<const CostTile>());
  content_.version = 1;
}

std::set<WindowedGround::Tile> WindowedGround::missing(const planner::Polyline& line,
                                                       double margin_cells) const {
  std::set<Tile> tiles;
  for (const maps::Point p : planner::subdivided(line, 0.25 * kSide * grid_.resolution_m)) {
    const double column = (p.x_m - grid_.south_west.x_m) / grid_.resolution_m,
                 row = (p.y_m - grid_.south_west.y_m) / grid_.resolution_m;
    const auto tile = [](double cell, int count) {
      return static_cast<int>(std::clamp(cell, 0.0, count - 1.0)) / kSide;
    };
    for (int r = tile(row - margin_cells, grid_.height); r <= tile(row + margin_cells, grid_.height); ++r)
      for (int c = tile(column - margin_cells, grid_.width); c <= tile(column + margin_cells, grid_.width);
           ++c)
        if (!read_.contains({r, c})) tiles.insert({r, c});
  }
  return tiles;
}

// Builds the box around some tiles of one block, with a tile more on every side for what slopes and
// kept-clear distances look at, and takes those tiles over.
void WindowedGround::read(const std::set<Tile>& tiles) {
  int row0 = tiles.begin()->first, row1 = row0, column0 = tiles.begin()->second, column1 = column0;
  for (const auto& [row, column] : tiles) {
    row0 = std::min(row0, row), row1 = std::max(row1, row);
    column0 = std::min(column0, column), column1 = std::max(column1, column);
  }
  const maps::Cell first{std::max(column0 - 1, 0) * kSide, std::max(row0 - 1, 0) * kSide};
  const maps::Cell last{std::min((column1 + 2) * kSide, grid_.width) - 1,
                        std::min((row1 + 2) * kSide, grid_.height) - 1};
  GroundOptions part = options_;
  part.dem.window.clear();
  part.dem.read.window = windowOf(grid_, first, last);
  std::optional<Ground> built;
  try {
    built.emplace(readGround(part, context_));
  } catch (const InputError&) {  // no data in the window: its tiles stay unknown
    for (const Tile& tile : tiles) read_.try_emplace(tile);
    return;
  }
  const auto version = built->map.published();
  const maps::Raster<float>& heights = built->map.elevation().elevation_m;
  content_.cost = version->content().cost;
  for (const auto& [row, column] : tiles) {
    const int r = row - first.row / kSide, c = column - first.column / kSide;
    content_.tiles.set(static_cast<std::size_t>(row * tilesAcross(grid_.width) + column),
                       version->content().tiles[static_cast<std::size_t>(r * version->tileColumns() + c)]);
    maps::Grid own{kSide + 2,
                   kSide + 2,
                   grid_.resolution_m,
                   {heights.grid().south_west.x_m + (c * kSide - 1) * grid_.resolution_m,
                    heights.grid().south_west.y_m + (r * kSide - 1) * grid_.resolution_m}};
    maps::Raster<float> copy(own, std::nanf(""));
    for (int y = 0; y < own.height; ++y)
      for (int x = 0; x < own.width; ++x)
        if (const maps::Cell from{c * kSide - 1 + x, r * kSide - 1 + y}; heights.grid().contains(from))
          copy[{x, y}] = heights[from];
    read_.emplace(Tile{row, column}, std::move(copy));
  }
}

std::shared_ptr<const costmap::CostGrid> WindowedGround::around(const planner::Polyline& line,
                                                                double margin_cells) {
  std::map<Tile, std::set<Tile>> blocks;
  for (const Tile& tile : missing(line, margin_cells))
    blocks[{tile.first / kBlock, tile.second / kBlock}].insert(tile);
  for (const auto& [block, tiles] : blocks) {
    if (context_.stop.stop_requested()) break;
    read(tiles);
  }
  if (!content_.cost) content_.cost = overview_.map.published()->content().cost;
  return std::make_shared<const costmap::CostGrid>(content_);
}

std::optional<double> WindowedGround::elevation_m(maps::Point point) const {
  const auto cell = grid_.cellAt(point);
  if (!cell) return std::nullopt;
  const auto tile = read_.find({cell->row / kSide, cell->column / kSide});
  if (tile == read_.end() || tile->second.empty()) return std::nullopt;
  return maps::elevationAt(tile->second, point);
}

}  // namespace talus::cli
