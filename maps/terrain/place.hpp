#pragma once

#include <string>
#include <string_view>
#include <variant>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A position stated by the user: map coordinates, or latitude and longitude.
using Place = std::variant<Point, GeoPoint>;

/// Parses "x,y" in map coordinates [m], or "lat,lon" in degrees with a trailing d on each number
/// ("-4.59d,137.44d"). @throws InputError that quotes the text
Place parsePlace(std::string_view text);

/// Map coordinates of a position inside the map. `name` begins the error message ("--start 10,20"). @throws
/// InputError if the map has no CRS for a latitude, or if the position lies outside the map (the message
/// states the bounds)
Point locate(const Place& place, const ElevationMap& map, const std::string& name);

/// A rectangle given by two opposite corners in any order.
struct Window {
  Place first;
  Place second;
};

/// Parses "x0,y0,x1,y1" in map coordinates [m], or "lat,lon,lat,lon" in degrees with a trailing d on each
/// number. @throws InputError that quotes the text
Window parseWindow(std::string_view text);

/// Returns the text of the bounds of a grid: "spans x 0 to 136 m, y 0 to 157 m".
std::string extent(const Grid& grid);

/// Returns the text of a position: "x 12.5 m, y 30.1 m", with a CRS also latitude and longitude in degrees.
std::string describe(Point point, const ElevationMap& map);

}  // namespace talus::maps
