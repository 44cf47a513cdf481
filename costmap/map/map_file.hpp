#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// All content of a map file that is not a raster, written as lines "name value". Numbers are written as the
/// shortest text that reads back to the same bits.
struct MapText {
  maps::Grid grid;
  std::optional<maps::CoordinateSystem> coordinate_system;
  std::string source;
  std::string reading{};           ///< ElevationMap::reading
  std::vector<InputFile> files{};  ///< ElevationMap::files
  double footprint_radius_m = 0.0;
  /// Rover, terrain classes and policy.
  GroundModel::Parts ground;
  std::vector<RefusedPlace> refused{};
};

/// Returns the content as text.
std::string written(const MapText& text);

/// Returns the content that the text of a map file contains. Throws InputError for a missing or unknown line,
/// or an invalid number; the error names the file `name`.
MapText parsed(const std::string& lines, const std::string& name);

}  // namespace talus::costmap
