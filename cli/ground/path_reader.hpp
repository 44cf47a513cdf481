#pragma once

#include <string>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus::cli {

/// Returns a polyline in map coordinates [m] from a file: the first line of a vector file, or a CSV table
/// whose columns x_m and y_m (also x and y, easting and northing: map metres) or lat and lon (degrees of the map's
/// georeference, WGS 84 on Earth) are named in any case. The polyline has at least one point. A route file of `talus plan` gives the
/// exact values of its properties x_m, y_m. Coordinates of such a file that differ from these properties by
/// more than a tenth of a cell were edited and are rejected. @throws InputError
std::vector<maps::Point> readPath(const std::string& path, const maps::ElevationMap& map);

}  // namespace talus::cli
