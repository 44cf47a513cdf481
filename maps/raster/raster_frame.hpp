#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/read_options.hpp>

namespace talus::maps {

/// A raster of square cells in metres with its grid.
struct FramedRaster {
  Dataset raster{};
  int band = 1;
  Grid grid{};           ///< grid of the whole raster
  bool north_up = true;  ///< true if the first row of the raster is the northernmost
  std::optional<Georeference> georeference{};
};

/// Determines the grid of a file; resamples pixels that are not square cells in metres. Decisions are added
/// to `notes`. `path` identifies the file in error messages. @throws InputError
FramedRaster frame(Dataset file, int band, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes);

}  // namespace talus::maps
