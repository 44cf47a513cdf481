#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::cli {

/// Ground too large to be held: an overview of all of it, and at full resolution the tiles around a route
/// only, read and built window by window. Memory grows with the route's length, not with the map.
class WindowedGround {
 public:
  /// Reads and builds the overview. @throws InputError
  WindowedGround(const GroundOptions& options, const Context& context);

  /// Whether the map that the options name is a DEM of more cells than this.
  static bool needed(const GroundOptions& options, std::size_t cells);

  const Ground& overview() const noexcept { return overview_; }
  Ground takeOverview() && { return std::move(overview_); }

  /// The map with the tiles that lie within a margin of a line, and those that were read before; all others
  /// unknown. The same tiles, to the bit, as of a map that is built as a whole.
  std::shared_ptr<const costmap::CostGrid> around(const planner::Polyline& line, double margin_cells);

  /// Elevation [m] on tiles that were read.
  std::optional<double> elevation_m(maps::Point point) const;

  /// Cells of the whole map; cells read at full resolution so far.
  const maps::Grid& grid() const noexcept { return grid_; }
  std::size_t cellsRead() const noexcept { return read_.size() * 64 * 64; }

 private:
  using Tile = std::pair<int, int>;  // row, column
  std::set<Tile> missing(const planner::Polyline& line, double margin_cells) const;
  void read(const std::set<Tile>& tiles);

  GroundOptions options_;
  Context context_;
  maps::Grid grid_;
  Ground overview_;
  costmap::CostGrid::Content content_;
  std::map<Tile, maps::Raster<float>> read_;  // elevation of tiles, one cell more to each side
};

}  // namespace talus::cli
