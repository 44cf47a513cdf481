#pragma once

#include <string>
#include <vector>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::cli {

/// A polyline in map metres from a file: the first line of a vector file, or a CSV table with the columns x_m,
/// y_m. At least one point. A route that this program wrote gives its properties x_m, y_m to the last bit; coordinates that
/// lie a tenth of a cell or more from those were edited and are refused. @throws InputError
std::vector<maps::Point> readPath(const std::string& path, const maps::ElevationMap& map);

}  // namespace talus::cli
