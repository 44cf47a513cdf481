#pragma once

#include <string>
#include <vector>

#include <talus/cli/ground/map_options.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/route/route_json.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Inputs of a traversability map: elevation map (DEM), layers, soils, rover and policy.
struct GroundOptions {
  MapOptions dem;
  LayerOptions layers;
  std::string map_file;  ///< file of --map, which `talus costmap` wrote with its own layers, soils and rover
  std::string soils;     ///< YAML file that assigns a soil to each terrain-class number
  /// Library name or YAML file of the soil for ground without a class; empty: default of the body.
  std::string soil;
  std::string model;     ///< refined model from `talus trace` for ground without a class, instead of `soil`
  std::string rover;     ///< library name or YAML file of the rover; empty: default of the body
  bool is_cost = false;  ///< dem.path is a raster of costs a metre, in place of heights, rover and soils
  std::string cost_curve{};  ///< CSV file of a cost over gradients in place of rover and soils; empty: none
  std::string mission{};     ///< mission file that stated options of the call; empty: none
  double footprint_m = 0.0;  ///< radius of the disc for slope fits; 0: derived from the rover
  costmap::TravelPolicy policy;
};

/// Declares the option --map and the options of addMapOptions() and addGroundChoices().
void addGroundOptions(CLI::App& command, GroundOptions& options);

/// Declares the options that apply to any map: those of addLayerOptions(), --soils, --soil, --model, --rover,
/// --footprint, and those of the policy.
void addGroundChoices(CLI::App& command, GroundOptions& options);

/// Declares the options --cost and --cost-curve.
void addCostCurve(CLI::App& command, GroundOptions& options);

/// A traversability map, with its files and computing times.
struct Ground {
  costmap::TraversabilityMap map;
  std::vector<InputFile> files;  ///< the manifest: files of the options first, then all others read
  /// Time for reading the files.
  double load_s = 0.0;
  /// Time for building the map.
  double build_s = 0.0;
};

/// Returns the files that the options name, each with its role; the first is the map.
std::vector<InputFile> filesOf(const GroundOptions& options);

/// Returns the default soil and the default rover for the body of the map.
std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map);

/// Returns a traversability map from its inputs. A DEM that is a file of `talus costmap` is treated like
/// --map. @throws InputError
Ground readGround(const GroundOptions& options, const Context& context);

}  // namespace talus::cli
