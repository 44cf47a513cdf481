#pragma once

#include <string>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// Returns the map coordinates [m] of a position that the user stated, which must lie inside the map. `text`
/// is "x,y", "lat,lon" with a trailing d on each number, or the path of a GeoJSON file. Of a GeoJSON file,
/// the first point is used (longitude and latitude, or map metres if the file has "crs": "local"). `name`
/// begins the error message ("--start"). @throws InputError
Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name);

}  // namespace talus::maps
