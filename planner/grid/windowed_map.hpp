#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Box of cells in map coordinates [m], with sides on cell borders.
struct MapBox {
  maps::Point low;   ///< south-western corner
  maps::Point high;  ///< north-eastern corner
};

/// Map that does not fit in memory: an overview of the whole map, and full-resolution tiles around a route,
/// built box by box. Memory grows with the length of the route, not with the map. Not thread-safe.
class WindowedMap {
 public:
  /// Grid, overview and source of the full-resolution cells.
  struct Parts {
    maps::Grid grid;                                    ///< grid of the whole map at full resolution
    std::shared_ptr<const costmap::CostGrid> overview;  ///< the whole map in larger cells
    /// Builds the cells of a box at full resolution; empty if the box contains no data. Called from one
    /// thread.
    std::function<std::optional<costmap::TraversabilityMap>(const MapBox&)> build;
  };

  /// Throws std::invalid_argument if `overview` or `build` is missing.
  explicit WindowedMap(Parts parts);

  /// Overview of the whole map.
  const std::shared_ptr<const costmap::CostGrid>& overview() const noexcept { return parts_.overview; }

  /// Map with the tiles within a margin [cells] of a line and all tiles built before; other tiles are
  /// unknown. The tiles are identical to those of a map built as a whole. Ends early when stopped. Throws
  /// std::invalid_argument if the built map does not cover exactly the cells of the box.
  std::shared_ptr<const costmap::CostGrid> around(const std::vector<maps::Point>& line, double margin_cells,
                                                  const ProgressMonitor& watch = {});

  /// Elevation [m] on tiles that were built; empty elsewhere.
  std::optional<double> elevation_m(maps::Point point) const;

  /// Grid of the whole map.
  const maps::Grid& grid() const noexcept { return parts_.grid; }
  /// Returns the number of cells built at full resolution so far, counted in whole tiles.
  std::size_t cellsBuilt() const noexcept;

 private:
  using Tile = std::pair<int, int>;  // row, column
  std::set<Tile> missing(const std::vector<maps::Point>& line, double margin_cells) const;
  void build(const std::set<Tile>& tiles);
  void take(const costmap::TraversabilityMap& built, maps::Cell first, const std::set<Tile>& tiles);

  Parts parts_;
  costmap::CostGrid::Content content_;
  std::map<Tile, maps::Raster<float>> built_;  // elevation of built tiles, with a border of one cell
};

}  // namespace talus::planner
