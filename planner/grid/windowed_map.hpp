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

/// Rectangle in map coordinates [m] with sides on cell borders.
struct MapBox {
  maps::Point low;   ///< south-western corner
  maps::Point high;  ///< north-eastern corner
};

/// Map that does not fit in memory: an overview of the whole map, and tiles (64 x 64 cells) of full
/// resolution around routes, which are computed box by box. Memory grows with the length of the routes, not
/// with the size of the map. Not thread-safe.
class WindowedMap {
 public:
  /// Grid, overview and source of the cells of full resolution.
  struct Parts {
    maps::Grid grid;                                    ///< grid of the whole map at full resolution
    std::shared_ptr<const costmap::CostGrid> overview;  ///< cost map of the whole map in larger cells
    /// Function that returns the map of a box at full resolution; empty if the box contains no data. It is
    /// called from one thread.
    std::function<std::optional<costmap::TraversabilityMap>(const MapBox&)> build;
  };

  /// Throws std::invalid_argument if `overview` or `build` is missing.
  explicit WindowedMap(Parts parts);

  /// Returns the overview of the whole map.
  const std::shared_ptr<const costmap::CostGrid>& overview() const noexcept { return parts_.overview; }

  /// Returns a cost map with the tiles within `margin_cells` of a line and with all tiles computed before;
  /// other tiles are unknown. The tiles are identical to those of a map that is computed as a whole. The
  /// computation ends early after a stop. Throws std::invalid_argument if the map that `build` returns does
  /// not cover exactly the cells of its box.
  std::shared_ptr<const costmap::CostGrid> around(const std::vector<maps::Point>& line, double margin_cells,
                                                  const ProgressMonitor& watch = {});

  /// Returns the elevation [m] on tiles that were computed; empty elsewhere.
  std::optional<double> elevation_m(maps::Point point) const;

  /// Returns the grid of the whole map.
  const maps::Grid& grid() const noexcept { return parts_.grid; }
  /// Returns the number of cells computed at full resolution so far, in whole tiles.
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
