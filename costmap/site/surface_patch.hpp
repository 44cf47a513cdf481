#pragma once

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Heights beyond lose steps of centimetres to single precision; no body that a rover drives on has them.
inline constexpr double kHighest_m = 131072.0;

/// The cells of a map that a patch covers; any_height: whether the map has an elevation anywhere. Throws
/// std::invalid_argument, in one line with place and remedy, for a patch of another resolution, between the map's cells
/// or beyond its edge, whose layers lie on different grids, that says nothing, or that holds an impossible value.
maps::CellBox placeOf(const SurfacePatch& patch, const GroundSite& site, bool any_height);

/// Throws std::invalid_argument, in one line with place and remedy, where a map's layers hold an impossible height or
/// share of rocks: they would count as no hazard, or as nothing at all.
void requirePossible(const MapLayers& layers);

/// The middle of the range of its heights [m], which keeps every height inside the octree; 0 where there is none.
/// The median would be steadier.
double middleElevation(const maps::Raster<float>& elevation_m);

}  // namespace talus::costmap
