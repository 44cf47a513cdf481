#pragma once

#include <optional>
#include <string>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// Target of resampling: square cells of 32-bit floats, NaN for no data.
struct WarpTarget {
  int band = 1;
  std::string wkt{};             ///< CRS of the result; empty: the CRS of the source
  double resolution = 0.0;       ///< cell side in units of the target CRS; 0: chosen by GDAL from the source
  std::optional<Grid> grid{};    ///< exact grid of the result, instead of `resolution`
  std::string method = "cubic";  ///< GDAL's resampling method: near, bilinear, cubic, average
  std::optional<double> nodata{};  ///< no-data value of the source; overrides the file
};

/// The resampled band as a virtual raster, computed on reading. `where` is the location in error messages.
/// @throws InputError
Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where);

}  // namespace talus::maps
