#pragma once

/// Umbrella header of talus::maps_io: includes readers of elevation, layers and positions from files, and the
/// writer of GeoTIFF files.

#include <talus/maps/maps.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/geotiff_writer.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/maps/vector/place_reader.hpp>
