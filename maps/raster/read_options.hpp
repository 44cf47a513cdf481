#pragma once

#include <cstdint>
#include <optional>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// Options for reading a raster file.
struct ReadOptions {
  std::optional<int> band{};  ///< from 1; unset: the band whose description names elevation, else the first
  std::optional<double> resolution_m{};  ///< cell side; required for a file without a CRS; else causes
                                         ///< resampling
  std::optional<Window> window{};        ///< part of the file to read, in map coordinates or degrees
  std::optional<double> nodata{};        ///< no-data value; overrides the file
  bool keep_zeros = false;  ///< treat regions of 0 as ground even if the surrounding values are not near 0
  double vertical_scale = 1.0;  ///< factor on the heights, applied after the conversion of the stated unit
  bool ignore_crs = false;      ///< ignore the CRS of the file and read local metres
  bool allow_vrt = false;       ///< accept a virtual raster whose files lie in its own folder
  /// Number of cells per side that are averaged into one cell, from the overviews of the file if present; >=
  /// 1.
  int overview = 1;
  std::uint64_t max_cells = 400'000'000;  ///< larger maps are rejected (the default takes 1.6 GB as float)
};

}  // namespace talus::maps
