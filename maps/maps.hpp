#pragma once

/// Entry header of talus::maps: elevation maps, heights from point clouds, places, georeference, slope and roughness.

#include <talus/maps/elevation_map.hpp>
#include <talus/maps/place.hpp>
#include <talus/maps/point_heights.hpp>
#include <talus/maps/terrain_metrics.hpp>
