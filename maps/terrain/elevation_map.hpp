#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/input_file.hpp>
#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A digital elevation model: the elevation of each square cell of a grid in map coordinates. Row 0 is the
/// southernmost row.
struct ElevationMap {
  /// Elevation above the datum of the body; NaN for cells without data, never infinite.
  Raster<float> elevation_m{};
  /// Conversion to latitude and longitude; nullopt: x and y are local metres.
  std::optional<Georeference> georeference{};
  std::string source{};  ///< path of the map file, as the user stated it
  /// How the numbers of the file became heights, one line: "heights = raw x 0.001 + 1500 m (file), ..."; empty
  /// if the map was not read from a raster.
  std::string reading{};
  std::vector<InputFile> files{};  ///< files from which the map was made, if they were recorded
  /// Decisions of the file reader that the user should know, one line each.
  std::vector<std::string> notes{};

  /// Returns the georeference if it can convert to latitude and longitude, or null.
  const Georeference* places() const noexcept {
    return georeference && georeference->reachesPlaces() ? &*georeference : nullptr;
  }
  /// Returns the grid of the cells.
  const Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// Returns the fraction of the cells that have an elevation, 0 to 1 [-].
double validFraction(const Raster<float>& elevation_m);

/// Returns the elevation [m] at a point in map coordinates, by bilinear interpolation between cell centres;
/// nullopt outside the map or next to a cell without data.
std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point);

/// Returns the elevation [m] at a point like the function above, for cell elevations that the function
/// `elevation_m` returns.
std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m);

}  // namespace talus::maps
