#pragma once

#include <string>
#include <vector>

#include <talus/cli/ground/map_options.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Inputs of a traversability map: DEM, layers, soils, rover, policy.
struct GroundOptions {
  MapOptions dem;
  LayerOptions layers;
  std::string map_file;      ///< --map: file of `talus costmap` with its own layers, soils and rover
  std::string soils;         ///< YAML: terrain class number -> soil
  std::string soil;          ///< library name or YAML, for ground without a class; empty: default of the body
  std::string model;         ///< refined model from `talus trace` for ground without a class, instead of soil
  std::string rover;         ///< library name or YAML; empty: default of the body
  double footprint_m = 0.0;  ///< radius of slope fits; 0: that of the rover
  costmap::TravelPolicy policy;
};

/// Declares the options of addMapOptions() and addGroundChoices(), and --map.
void addGroundOptions(CLI::App& command, GroundOptions& options);

/// Declares the options that apply to any map: addLayerOptions(), --soils, --soil, --model, --rover,
/// --footprint and the options of the policy.
void addGroundChoices(CLI::App& command, GroundOptions& options);

/// A traversability map and how it was obtained.
struct Ground {
  costmap::TraversabilityMap map;
  std::vector<std::string> files;  ///< files read, for the provenance
  double load_s = 0.0;
  double build_s = 0.0;
};

/// Default soil and rover for the body of the map.
std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map);

/// Reads and builds a map. A DEM that is a file of `talus costmap` is used as --map. @throws InputError
Ground readGround(const GroundOptions& options, const Context& context);

}  // namespace talus::cli
