#pragma once

#include <optional>
#include <string>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// What a raster is resampled to: square cells of 32-bit floats, NaN where there is no data.
struct WarpTarget {
  int band = 1;
  std::string wkt{};             ///< CRS of the result; empty: the source's own coordinates
  double resolution = 0.0;       ///< cell side in units of the target CRS; 0: as many cells as the source has
  std::optional<Grid> grid{};    ///< exactly these cells, instead of resolution
  std::string method = "cubic";  ///< GDAL's name: near, bilinear, cubic, average
  std::optional<double> nodata{};  ///< no-data value of the source; overrides the file
};

/// The band as a virtual raster that is computed where it is read. @throws InputError; `where` opens its line
Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where);

}  // namespace talus::maps
