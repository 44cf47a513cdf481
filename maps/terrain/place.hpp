#pragma once

#include <string>
#include <string_view>
#include <variant>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// Where a user points to: map metres, or latitude and longitude.
using Place = std::variant<Point, GeoPoint>;

/// Reads "x,y" in map metres or "lat,lon" in degrees with a trailing d on each ("-4.59d,137.44d").
/// @throws InputError that quotes the text
Place parsePlace(std::string_view text);

/// The place in map metres, inside the map. `name` opens the error line ("--start 10,20").
/// @throws InputError when the map has no CRS for a latitude, or the place lies outside, with the map's
/// bounds
Point locate(const Place& place, const ElevationMap& map, const std::string& name);

/// Two opposite corners of a box, in any order.
struct Window {
  Place first;
  Place second;
};

/// Reads "x0,y0,x1,y1" in map metres or "lat,lon,lat,lon" in degrees with a trailing d on each.
/// @throws InputError that quotes the text
Window parseWindow(std::string_view text);

/// "spans x 0 to 136 m, y 0 to 157 m".
std::string extent(const Grid& grid);

/// "x 12.5 m, y 30.1 m" and, with a CRS, the latitude and longitude in degrees as well.
std::string describe(Point point, const ElevationMap& map);

}  // namespace talus::maps
