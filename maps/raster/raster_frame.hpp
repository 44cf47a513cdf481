#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/read_options.hpp>

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

/// Square cells in metres that a raster file has, or to which it is resampled.
struct FramedRaster {
  Grid grid{};           ///< grid of the whole raster in map coordinates
  bool north_up = true;  ///< true if the first row is the northernmost row
  std::optional<Georeference> georeference{};
  std::string resampling{};  ///< method of WarpTarget; empty: the pixels of the file are the cells
};

/// Returns the frame of a file: its own pixels if they are square cells in metres of the stated resolution,
/// else cells of a projection to which its heights must be resampled. Decisions are appended to `notes`. `path`
/// names the file in error messages. @throws InputError, also if ReadOptions::resolution_m contradicts the
/// pixel size of a file without a CRS
FramedRaster frame(GDALDataset& file, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes);

}  // namespace talus::maps
