#pragma once

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Limit of |height|, below which single precision resolves at least 1/64 m. No planetary surface exceeds the
/// limit.
inline constexpr double kHighest_m = 131072.0;

/// The cells of a map that a patch covers; any_height: true if the map has an elevation. Throws
/// std::invalid_argument with place and remedy for a patch of another resolution, not aligned with the cells,
/// beyond the edge, with layers on different grids, without content, or with an invalid value.
maps::CellBox placeOf(const SurfacePatch& patch, const GroundSite& site, bool any_height);

/// Throws std::invalid_argument with place and remedy if a layer of the map has an invalid height or rock
/// abundance: invalid values would be read as no hazard or as no data.
void requirePossible(const MapLayers& layers);

/// Middle of the range of the heights [m], which keeps all heights inside the octree; 0 without heights.
double middleElevation(const maps::Raster<float>& elevation_m);

}  // namespace talus::costmap
