#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Class number of a cell without a terrain class.
inline constexpr std::uint8_t kNoClass = 255;

/// File and band of a layer, i.e. of a raster in addition to the elevation.
struct LayerSource {
  std::string path{};
  /// Band number from 1; unset: the band whose description fits the layer, or otherwise the first band.
  std::optional<int> band{};
};

/// Returns the terrain classes (0 to 254) of a file on the grid of the map. A cell receives the weakest of
/// the classes whose pixels overlap the cell, so that a small weak area between cell centres is kept. The
/// order from strong to weak is: the classes in the order of `weakest_last`; the other classes by number;
/// kNoClass (no data). @throws InputError, also if the file and the map do not overlap or a value is not a
/// class number
Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map,
                                        std::span<const int> weakest_last = {});

/// Rock abundance on the grid of the map: each cell has the maximum of all pixels of the file that overlap
/// the cell.
struct RockAbundance {
  /// Rock abundance: fraction of the area covered by rocks, 0 to 1; NaN without data [-].
  Raster<float> share;
  Raster<std::uint8_t> unseen;  ///< non-zero if the file has no data in a part of the cell
};

/// Returns the rock abundance of a file on the grid of the map. @throws InputError, also if the file and the
/// map do not overlap or a value lies outside 0 to 1
RockAbundance readRockAbundance(const LayerSource& source, const ElevationMap& map);

/// Additional drive cost per metre on the grid of the map: each cell has the maximum of all pixels of the
/// file that overlap the cell. An infinite cost (at least one pixel is infinite) means that the cell is
/// impassable. NaN means that no pixel is infinite and that a part of the cell has no data.
struct AddedJoules {
  /// Additional cost [J/m].
  Raster<float> J_per_m;
  float highest_J_per_m = 0.0F;  ///< maximum finite cost of the whole file [J/m]
};

/// Returns the additional costs of a file on the grid of the map. @throws InputError, also if the file and
/// the map do not overlap or a finite value lies outside 0 to 1e6
AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map);

/// Keep-out areas, which the rover must not enter, on the grid of the map.
struct KeepOut {
  Raster<std::uint8_t> mask;       ///< 1 in every cell that a keep-out polygon touches, 0 in other cells
  std::vector<std::string> notes;  ///< one sentence about the features of the file outside the map
};

/// Returns the keep-out areas of a vector file with polygons. A GeoJSON file has longitudes and latitudes, or
/// map coordinates if the map has no CRS or the file states "crs": "local". Polygons are rasterised
/// separately, so that a hole of one polygon does not remove the area of another. @throws InputError, also if
/// a feature is not a polygon or has no area, or if no polygon overlaps the map
KeepOut readKeepOut(const std::string& path, const ElevationMap& map);

}  // namespace talus::maps
