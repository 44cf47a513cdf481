#pragma once

#include <optional>
#include <string>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// Target of resampling a raster: square cells of 32-bit floats; NaN marks cells without data.
struct WarpTarget {
  /// WKT of the coordinate reference system (CRS) of the result; empty: the CRS of the source.
  std::string wkt{};
  /// Side length of a cell in units of the target CRS; 0: GDAL chooses the size from the source.
  double resolution = 0.0;
  std::optional<Grid> grid{};    ///< exact grid of the result, instead of `resolution`
  std::string method = "cubic";  ///< GDAL's resampling method: near, bilinear, cubic, average
};

/// Returns the resampled raster as a virtual raster, which is computed on reading. NaN means no data in
/// floating-point bands that declare no value for it. `where` names the file in error messages. @throws InputError
Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where);

}  // namespace talus::maps
