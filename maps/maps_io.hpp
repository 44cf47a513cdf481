#pragma once

/// Entry header of talus::maps_io: elevation and layers from files, GeoTIFF written.

#include <talus/maps/maps.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/geotiff_writer.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/maps/vector/place_reader.hpp>
