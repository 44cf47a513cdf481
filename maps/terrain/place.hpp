#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A position stated by the user: map coordinates, or latitude and longitude.
using Place = std::variant<Point, GeoPoint>;

/// Returns the position that a text states: "x,y" in map coordinates [m], or "lat,lon" in degrees with a
/// trailing d on each number ("-4.59d,137.44d"). @throws InputError that quotes the text
Place parsePlace(std::string_view text);

/// Returns the place of the map that a pair in metres is when read as degrees, in either order; nullopt if it is none, or
/// in the cell of the pair.
std::optional<GeoPoint> asDegrees(Point given, const ElevationMap& map);

/// Returns the map coordinates [m] of a position. @throws InputError that begins with `name` if it has a latitude and the
/// map no georeference
Point inMetres(const Place& place, const ElevationMap& map, const std::string& name);

/// Returns the map coordinates of a position inside the map. `name` begins the error message ("--start
/// 10,20"). @throws InputError if the position has a latitude but the map has no coordinate reference system
/// (CRS), if the position lies outside the map (the message states the bounds), or if a position in metres is
/// another one of the map when read as degrees
Point locate(const Place& place, const ElevationMap& map, const std::string& name);

/// A rectangle given by two opposite corners, in any order.
struct Window {
  Place first;
  Place second;
};

/// Returns the rectangle that a text states: "x0,y0,x1,y1" in map coordinates [m], or "lat,lon,lat,lon" in
/// degrees with a trailing d on each number. @throws InputError that quotes the text
Window parseWindow(std::string_view text);

/// Returns the bounds of a grid as text: "spans x 0 to 136 m, y 0 to 157 m".
std::string extent(const Grid& grid);

/// Returns a position as text: "x 12.5 m, y 30.1 m"; for a map with a CRS also latitude and longitude in
/// degrees.
std::string describe(Point point, const ElevationMap& map);

}  // namespace talus::maps
