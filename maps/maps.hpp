#pragma once

/// Entry header of talus::maps: elevation maps, places, georeference, slope and roughness.

#include <talus/maps/elevation_map.hpp>
#include <talus/maps/place.hpp>
#include <talus/maps/terrain_metrics.hpp>
