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

/// A box of cells in map metres, its sides on cell borders.
struct MapBox {
  maps::Point low;
  maps::Point high;
};

/// A map too large to be held: an overview of all of it, and at full resolution the tiles around a route only,
/// built box by box. Memory grows with the route's length, not with the map. Not thread-safe.
class WindowedMap {
 public:
  struct Parts {
    maps::Grid grid;                                    ///< of the whole map at full resolution
    std::shared_ptr<const costmap::CostGrid> overview;  ///< of the whole map in larger cells
    /// Builds the cells of a box at full resolution; none where the box holds no data. Called from one thread.
    std::function<std::optional<costmap::TraversabilityMap>(const MapBox&)> build;
  };

  /// Throws std::invalid_argument without an overview or without build.
  explicit WindowedMap(Parts parts);

  const std::shared_ptr<const costmap::CostGrid>& overview() const noexcept { return parts_.overview; }

  /// The map with the tiles that lie within a margin [cells] of a line, and those that were built before; all
  /// others unknown. The same tiles, to the bit, as of a map that is built as a whole. Ends early when asked
  /// to stop. Throws std::invalid_argument where what was built is not the cells of the box.
  std::shared_ptr<const costmap::CostGrid> around(const std::vector<maps::Point>& line, double margin_cells,
                                                  const ProgressMonitor& watch = {});

  /// Elevation [m] on tiles that were built.
  std::optional<double> elevation_m(maps::Point point) const;

  /// Cells of the whole map; cells built at full resolution so far.
  const maps::Grid& grid() const noexcept { return parts_.grid; }
  std::size_t cellsBuilt() const noexcept;

 private:
  using Tile = std::pair<int, int>;  // row, column
  std::set<Tile> missing(const std::vector<maps::Point>& line, double margin_cells) const;
  void build(const std::set<Tile>& tiles);
  void take(const costmap::TraversabilityMap& built, maps::Cell first, const std::set<Tile>& tiles);

  Parts parts_;
  costmap::CostGrid::Content content_;
  std::map<Tile, maps::Raster<float>> built_;  // elevation of tiles, one cell more to each side
};

}  // namespace talus::planner
