#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/read_options.hpp>

namespace talus::maps {

/// A raster whose pixels are square cells in metres, and where they lie.
struct FramedRaster {
  Dataset raster{};
  int band = 1;
  Grid grid{};           ///< of the whole raster
  bool north_up = true;  ///< the raster's first row is the northernmost
  std::optional<Georeference> georeference{};
};

/// Finds where the pixels of a file lie and resamples them where they are not square cells in metres; says in
/// `notes` what was decided. `path` opens error lines.
/// @throws InputError
FramedRaster frame(Dataset file, int band, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes);

}  // namespace talus::maps
