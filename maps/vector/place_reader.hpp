#pragma once

#include <string>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// Parses a place given by the user; returns map coordinates inside the map [m]. Accepts "x,y", "lat,lon"
/// with a trailing d, or the path of a GeoJSON file, whose first point is used (longitude, latitude; map
/// metres if the file has "crs": "local"). `name` begins the error message ("--start").
/// @throws InputError
Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name);

}  // namespace talus::maps
