#pragma once

#include <string>

#include <talus/maps/terrain/place.hpp>

namespace talus::maps {

/// A place as a user gives it, in map metres inside the map: "x,y", "lat,lon" with a trailing d, or the path
/// of a GeoJSON file whose first point it is (longitude, latitude; map metres where the file says "crs":
/// "local"). `name` opens the error line ("--start").
/// @throws InputError
Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name);

}  // namespace talus::maps
