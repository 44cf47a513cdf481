#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Class number of a cell without a class.
inline constexpr std::uint8_t kNoClass = 255;

/// File and band of a layer.
struct LayerSource {
  std::string path{};
  std::optional<int> band{};  ///< from 1; unset: the band whose description fits the layer, else the first
};

/// Terrain classes 0 to 254 on the grid of the map. A cell gets the weakest of the classes whose pixels
/// overlap it, so that a small weak patch between cell centres is kept. Order: the classes of `weakest_last`,
/// then the other classes by number, then kNoClass (no data) as the weakest. @throws InputError, also if the
/// file and the map do not overlap or a value is not a class number
Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map,
                                        std::span<const int> weakest_last = {});

/// Rock abundance on the grid of the map: the maximum of all pixels of the file that overlap a cell.
struct RockAbundance {
  Raster<float> share;               ///< fraction of the area covered by rocks [-], 0 to 1; NaN without data
  Raster<std::uint8_t> unseen;       ///< non-zero if the file has no data in a part of the cell
  std::vector<std::string> notes{};  ///< decisions of the reader, one sentence each
};

/// Reads rock abundance. @throws InputError, also if the file and the map do not overlap or a value lies
/// outside 0 to 1
RockAbundance readRockAbundance(const LayerSource& source, const ElevationMap& map);

/// Additional drive cost [J/m] on the grid of the map: the maximum of all pixels of the file that overlap a
/// cell. Infinite: the cell is impassable, because at least one pixel is infinite. NaN: no pixel is infinite,
/// and a part of the cell has no data.
struct AddedJoules {
  Raster<float> J_per_m;
  float highest_J_per_m = 0.0F;  ///< maximum finite value of the whole file
};

/// Reads additional costs. @throws InputError, also if the file and the map do not overlap or a finite value
/// lies outside 0 to 1e6
AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map);

/// Keep-out areas on the map's grid.
struct KeepOut {
  Raster<std::uint8_t> mask;       ///< 1 in every cell that a polygon touches, else 0
  std::vector<std::string> notes;  ///< one sentence on the features outside the map
};

/// Reads keep-out polygons from a vector file (GeoJSON: longitude, latitude; map coordinates if the map has
/// no CRS or the file states "crs": "local"). Polygons are rasterised separately, so that a hole of one
/// polygon does not open another. @throws InputError, also if a feature is not a polygon or has no area, or
/// if no polygon overlaps the map
KeepOut readKeepOut(const std::string& path, const ElevationMap& map);

}  // namespace talus::maps
