#pragma once

/// Entry header of talus::maps: elevation maps, heights from point clouds, positions, georeference, slope and
/// roughness.

#include <talus/maps/grid/point_heights.hpp>
#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/maps/terrain/place.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>
