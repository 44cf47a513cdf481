#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Class number of a cell that the class raster does not cover.
inline constexpr std::uint8_t kNoClass = 255;

/// A layer's file and the band to take from it.
struct LayerSource {
  std::string path{};
  std::optional<int> band{};  ///< from 1; unset: the first, or for rock abundance the band so named
};

/// Terrain classes (whole numbers 0 to 254) on the map's grid: of all that reach into a cell the one that comes last in
/// `weakest_last`, then those that it does not name (greatest number last, ground without a class the very last), so that no
/// weak patch is lost between the middles of cells. kNoClass where the file has none.
/// @throws InputError, also when the file and the map do not overlap or a value is no class number
Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map,
                                        std::span<const int> weakest_last = {});

/// Rocks on the map's grid, of all that the file knows of a cell the greatest share.
struct RockAbundance {
  Raster<float> share;          ///< of the ground covered by rocks [-], 0 to 1; NaN where nothing is known
  Raster<std::uint8_t> unseen;  ///< not 0: the file has no data in a part of the cell
  std::vector<std::string> notes{};  ///< what the reader decided, a sentence each
};

/// @throws InputError, also when the file and the map do not overlap or a value lies outside 0 to 1
RockAbundance readRockAbundance(const LayerSource& source, const ElevationMap& map);

/// What a metre costs more [J/m] on the map's grid: the greatest value of any cell of the file that reaches into a cell.
/// Infinite: refused, also where that holds of a part of the cell alone; NaN where a part of it has no data and nothing is refused.
struct AddedJoules {
  Raster<float> J_per_m;
  float dearest_J_per_m = 0.0F;  ///< finite value of the whole file
};

/// @throws InputError, also when the file and the map do not overlap or a value is negative or above 1e6
AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map);

/// Keep-out areas on the map's grid.
struct KeepOut {
  Raster<std::uint8_t> mask;       ///< 1 in every cell that a polygon touches, else 0
  std::vector<std::string> notes;  ///< which features lie beside the map, one sentence
};

/// Keep-out polygons of a vector file (GeoJSON: longitude, latitude; or map metres where the map has no CRS or the file
/// says "crs": "local"). Each is drawn by itself, so that none opens what another closes: what its outer ring winds
/// round, less its holes.
/// @throws InputError, also when a feature is no polygon or encloses no ground, or none meets the map
KeepOut readKeepOut(const std::string& path, const ElevationMap& map);

}  // namespace talus::maps
