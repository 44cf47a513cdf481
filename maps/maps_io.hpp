#pragma once

/// Entry header of talus::maps_io: elevation and layers from files, GeoTIFF written.

#include <talus/maps/elevation_reader.hpp>
#include <talus/maps/geotiff_writer.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/place_reader.hpp>
