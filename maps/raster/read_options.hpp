#pragma once

#include <cstdint>
#include <optional>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// Options for reading a raster file.
struct ReadOptions {
  /// Band number from 1; unset: the band whose description names elevation, or otherwise the first band.
  std::optional<int> band{};
  /// Side length of a cell. Required for a file without a coordinate reference system (CRS); for other files,
  /// a value causes resampling.
  std::optional<double> resolution_m{};
  std::optional<Window> window{};  ///< part of the file to read, in map coordinates or degrees
  std::optional<double> nodata{};  ///< value of cells without data; overrides the value that the file states
  /// True if single cells without data stay without data. False: such a cell whose neighbours agree is
  /// interpolated (readElevation()).
  bool keep_holes = false;
  /// Factor on the heights, applied after the conversion from the unit that the file states [-]. Where the file
  /// states a unit that is not known, metres per unit.
  std::optional<double> vertical_scale{};
  bool ignore_crs = false;  ///< true if the CRS of the file is ignored and coordinates are local metres
  /// True if a virtual raster (VRT) is accepted whose source files lie in its own folder.
  bool allow_vrt = false;
  /// Number of cells per side, >= 1, whose mean becomes one cell. Overviews (coarser copies) of a file are not
  /// read.
  int overview = 1;
  /// Maximum number of cells; larger maps are rejected (the default takes 1.6 GB as float).
  std::uint64_t max_cells = 400'000'000;
};

}  // namespace talus::maps
