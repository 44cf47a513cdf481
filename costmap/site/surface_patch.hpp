#pragma once

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Limit of the magnitude of elevations [m]; below this limit, single precision resolves at least 1/64 m. No
/// planetary surface exceeds the limit.
inline constexpr double kHighest_m = 131072.0;

/// Returns the cells of a map that a patch (new observation of a window) covers. `any_height` is true if the
/// map has an elevation. Throws std::invalid_argument, with location and remedy, if the patch has another
/// resolution, is not aligned with the cells, extends beyond the map's edge, has layers on different grids,
/// has no content, or has an invalid value.
maps::CellBox placeOf(const SurfacePatch& patch, const GroundSite& site, bool any_height);

/// Checks the layers of a map. Throws std::invalid_argument, with location and remedy, if an elevation or
/// rock abundance is invalid: an invalid value would be read as no hazard or as no data.
void requirePossible(const MapLayers& layers);

/// Returns the middle of the range of the elevations [m]; 0 if there are no elevations. As the base of the
/// octree, this value keeps all elevations inside the octree.
double middleElevation(const maps::Raster<float>& elevation_m);

}  // namespace talus::costmap
