#pragma once

#include <string>
#include <vector>

#include <talus/maps/elevation_map.hpp>

namespace talus::cli {

/// A polyline in map metres from a file: the first LineString of a GeoJSON document (a route that this
/// program wrote gives its x_m, y_m to the last bit), or a CSV table with the columns x_m, y_m. At least one
/// point. @throws InputError
std::vector<maps::Point> readPath(const std::string& path, const maps::ElevationMap& map);

}  // namespace talus::cli
