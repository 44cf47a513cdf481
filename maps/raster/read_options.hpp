#pragma once

#include <cstdint>
#include <optional>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// How a raster file is read.
struct ReadOptions {
  std::optional<int> band{};             ///< from 1; unset: the band named like elevation, else the first
  std::optional<double> resolution_m{};  ///< cell side; must be given without a CRS, resamples with one
  std::optional<Window> window{};        ///< part of the file, in the file's map metres or degrees
  std::optional<double> nodata{};        ///< value that means no data, over what the file says
  bool keep_zeros = false;               ///< regions of 0 are ground though what is around them is not near 0
  double vertical_scale = 1.0;           ///< metres per unit of the file, on top of the unit it states
  bool ignore_crs = false;               ///< the file's CRS is wrong: read as local metres
  bool allow_vrt = false;                ///< take a virtual raster whose files lie in its own folder
  /// Cells to a side that are read as one, their mean, from the file's overviews if it has some.
  int overview = 1;
  std::uint64_t max_cells = 400'000'000;  ///< refuse larger maps (1.6 GB as float)
};

}  // namespace talus::maps
