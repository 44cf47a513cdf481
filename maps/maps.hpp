#pragma once

/// Umbrella header of talus::maps: includes elevation maps with georeference, heights from point clouds,
/// positions, and slope and roughness.

#include <talus/maps/grid/point_heights.hpp>
#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/maps/terrain/place.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>
