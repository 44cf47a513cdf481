#pragma once

#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps_io.hpp>

namespace talus::cli {

/// Returns the layers of a map as GeoTIFF bands: elevation, slope, aspect, roughness, step, class, category
/// (of the worst heading), allowed_headings (AllowedHeadings), drawbar_pull_over_load, drawbar_pull_over_load_std,
/// sinkage_over_radius, energy_per_metre_uphill, energy_per_metre_downhill. Units are SI and radians; NaN:
/// unknown. Categories are 0 safe, 1 marginal, 2 dangerous, 3 unknown; cells with a hazard are dangerous.
std::vector<maps::Layer> siteLayers(const costmap::TraversabilityMap& map, int threads);

}  // namespace talus::cli
