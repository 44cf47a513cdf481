#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A digital elevation model in map metres, square cells, row 0 south.
struct ElevationMap {
  Raster<float> elevation_m{};  ///< above the body's datum; NaN where there is no data, never infinite
  std::optional<Georeference> georeference{};  ///< none: x, y are local metres
  std::string source{};                        ///< the file it came from, as the user named it
  std::vector<std::string> notes{};  ///< what the reader decided that a person should know, a line each

  /// The georeference where it reaches latitude and longitude, else null.
  const Georeference* places() const noexcept {
    return georeference && georeference->reachesPlaces() ? &*georeference : nullptr;
  }
  const Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// Share of the cells that hold an elevation [-], 0 to 1.
double validFraction(const Raster<float>& elevation_m);

/// Elevation [m] at a point, bilinear between cell centres; nothing outside the map or beside nodata.
std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point);

/// The same of a grid whose cells have the elevations that the function returns.
std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m);

}  // namespace talus::maps
