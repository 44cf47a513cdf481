#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// All content of a map file that is not a raster, as lines "name value". Numbers are written as the shortest
/// text that reads back to the same bits.
struct MapText {
  maps::Grid grid;
  std::optional<maps::CoordinateSystem> coordinate_system;
  std::string source;
  double footprint_radius_m = 0.0;
  GroundModel::Parts ground;
  std::vector<RefusedPlace> refused{};
};

/// The text of a map.
std::string written(const MapText& text);

/// Parses the text of a map. Throws InputError (where = name) for a missing or unknown line, or an invalid
/// number.
MapText parsed(const std::string& lines, const std::string& name);

}  // namespace talus::costmap
