#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// Everything of a map file that is not a raster: a line "name value" each, numbers as the shortest text that
/// reads back to the same bits.
struct MapText {
  maps::Grid grid;
  std::optional<maps::CoordinateSystem> coordinate_system;
  std::string source;
  double footprint_radius_m = 0.0;
  GroundModel::Parts ground;
  std::vector<RefusedPlace> refused{};
};

/// The lines of a map's text.
std::string written(const MapText& text);

/// Reads them back. Throws InputError (where = name) for a line that is missing, unknown or no number.
MapText parsed(const std::string& lines, const std::string& name);

}  // namespace talus::costmap
