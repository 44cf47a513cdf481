#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/read_options.hpp>

namespace talus::maps {

/// A raster of square cells in metres, with its grid.
struct FramedRaster {
  Dataset raster{};
  int band = 1;
  Grid grid{};           ///< grid of the whole raster in map coordinates
  bool north_up = true;  ///< true if the first row of `raster` is the northernmost row
  std::optional<Georeference> georeference{};
};

/// Returns a band of a file as a raster of square cells in metres; resamples the band if its pixels are not
/// square cells in metres. Decisions are appended to `notes`. `path` names the file in error messages.
/// @throws InputError
FramedRaster frame(Dataset file, int band, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes);

}  // namespace talus::maps
