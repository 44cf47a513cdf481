#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A digital elevation model: square cells in map coordinates, row 0 the southernmost.
struct ElevationMap {
  Raster<float> elevation_m{};  ///< above the datum of the body; NaN for no data, never infinite
  std::optional<Georeference> georeference{};  ///< nullopt: x, y are local metres
  std::string source{};                        ///< path of the file, as the user stated it
  std::vector<std::string> notes{};  ///< decisions of the reader that the user should know, one line each

  /// The georeference if it converts to latitude and longitude, else null.
  const Georeference* places() const noexcept {
    return georeference && georeference->reachesPlaces() ? &*georeference : nullptr;
  }
  const Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// Fraction of the cells with an elevation [-], 0 to 1.
double validFraction(const Raster<float>& elevation_m);

/// Elevation [m] at a point by bilinear interpolation between cell centres; nullopt outside the map or next
/// to a cell without data.
std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point);

/// Elevation [m] at a point of a grid whose cell elevations are given by a function.
std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m);

}  // namespace talus::maps
