#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <talus/common/input_file.hpp>
#include <talus/planner/plan/map.hpp>
#include <talus/planner/site/elevation_file.hpp>

/// Reading of a site from files. Needs GDAL and yaml-cpp (talus::site).
namespace talus {

/// Files of a site. An empty path means that there is no such file.
struct SiteFiles {
  ElevationFile elevation;
  std::string classes{};  ///< raster of terrain classes
  std::optional<int> classes_band{};
  std::string rocks{};  ///< raster of rock abundance
  std::optional<int> rocks_band{};
  std::vector<std::string> keep_out{};  ///< vector files with keep-out polygons
  std::vector<std::string> costs{};     ///< layers NAME=FILE with additional energy [J/m]
  std::string soils{};                  ///< YAML file that assigns a soil to each terrain-class number
  /// Library name or YAML file of the soil for ground without a class; empty: default of the body.
  std::string soil{};
  std::string model{};   ///< refined model from `talus trace` for ground without a class, instead of `soil`
  std::string rover{};   ///< library name or YAML file of the rover; empty: default of the body
  bool is_cost = false;  ///< `elevation` is a raster of costs a metre, in place of heights, rover and soils
  std::string cost_curve{};  ///< CSV file of a cost over gradients in place of rover and soils
  double footprint_m = 0.0;  ///< radius of the disc for slope fits; 0: derived from the rover
  costmap::TravelPolicy policy{};
  std::vector<InputFile> further{};  ///< other files that the manifest names, with their roles
};

/// Returns the files that `files` names, each with its role; the first is the map.
std::vector<InputFile> filesOf(const SiteFiles& files);

/// Returns the manifest: the files of filesOf(), then all others that were read since the InputRecord of the thread
/// began. A file that is named and was not read is unused.
std::vector<InputFile> manifestOf(const SiteFiles& files);

/// Returns the default soil and the default rover for the body of the map.
std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map);

/// Reads a site: layers on the grid of the elevation map, rover and soils. Its elevation map lists all files read
/// (maps::ElevationMap::files). If several terrain classes meet in a cell, the weakest is used; cells without rock
/// data become unknown in a cost layer named "rocks". @throws InputError
Site readSite(const SiteFiles& files, const SiteReading& reading = {});

}  // namespace talus
