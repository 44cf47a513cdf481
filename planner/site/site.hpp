#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/planner.hpp>

namespace talus {

/// File of an elevation map, and options for reading it.
struct ElevationFile {
  ElevationFile() = default;
  ElevationFile(std::string file) : path(std::move(file)) {}
  ElevationFile(const char* file) : path(file) {}

  std::string path;  ///< raster or OctoMap
  std::string
      window{};  ///< part of the raster: "x0,y0,x1,y1", or "lat,lon,lat,lon" with the suffix d on each
  std::optional<double> below_m{};  ///< for an OctoMap only: ground above this height is not used
  maps::ReadOptions read{};
};

/// How files are read, and what is told meanwhile.
struct SiteReading {
  int threads = 1;                               ///< number of threads, >= 1
  std::function<void(std::string_view)> note{};  ///< receives assumptions and repairs, one line each
  ProgressMonitor watch{};
  void tell(std::string_view line) const {
    if (note) note(line);
  }
};

/// Returns the elevation map, also that of a file of `talus costmap`. @throws InputError
maps::ElevationMap readMap(const ElevationFile& file, const SiteReading& reading = {});

/// Returns the map of a file of `talus costmap`, with latitude and longitude by PROJ. @throws InputError
costmap::TraversabilityMap readBuiltMap(const std::string& path, const SiteReading& reading = {});

/// Checks that no options for reading rasters are given for an OctoMap or a built map, which have their own
/// grid. @throws InputError otherwise
void refuseReadOptions(const ElevationFile& file);

/// Costs per horizontal metre that a file states, by class number. `classed` is false for a file without a column
/// `class`; its one class has the number 0.
struct CostCurves {
  costmap::StatedCosts costs;
  std::vector<int> numbers;  ///< class numbers, ascending, in the order of costs.states
  bool classed = false;
};

/// Reads a cost per horizontal metre over gradients (rise over run) from a CSV file with the columns gradient_along
/// (climbing > 0), cost_per_m, and optionally gradient_across (>= 0, left and right equal) and class (0 to 254). Costs are
/// > 0; an empty field or inf refuses the gradients. Each class has all pairs of its gradients along and across, two
/// or more along, and across from 0. Costs are interpolated bilinearly; gradients beyond the table are refused, and so
/// is a gradient along above 1. Costs must not decrease with the gradient across. @throws InputError
CostCurves readCostCurves(const std::string& path);

/// Ground of which only the cost per metre of each cell is known, the same in every heading. Its elevation is 0.
struct CostRaster {
  maps::ElevationMap map;
  maps::Raster<std::uint8_t>
      classes;                 ///< class of each cell; kRefusedCost: impassable; maps::kNoClass: no data
  costmap::StatedCosts costs;  ///< by class: the value, or the upper end of a level of at most 3 %
};

/// Class number of cells that no heading may enter.
inline constexpr std::uint8_t kRefusedCost = 254;

/// Reads `file.path`: a raster of costs per metre, above 0, where infinite is impassable; or the YAML file of a Nav2
/// map (image, resolution, origin, negate, occupied_thresh, free_thresh), whose free cells cost 1 a metre and whose
/// occupied cells are impassable. @throws InputError
CostRaster readCostRaster(const ElevationFile& file, const SiteReading& reading);

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
