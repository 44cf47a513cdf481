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

/// Everything that a map of what may be driven is built from: DEM, layers, soils, rover, policy.
struct GroundOptions {
  MapOptions dem;
  LayerOptions layers;
  std::string map_file;  ///< --map: built already by `talus costmap`; its own layers, soils and rover hold
  std::string soils;     ///< YAML: terrain class number -> soil
  std::string soil;      ///< library name or YAML, of ground without a class; empty: by the body
  std::string model;     ///< refined model of ground without a class, made by `talus trace`, in place of soil
  std::string rover;     ///< library name or YAML; empty: by the body
  double footprint_m = 0.0;  ///< radius that slopes are taken over; 0: of the rover
  costmap::DrivePolicy policy;
};

/// Declares what addMapOptions and addGroundChoices declare, and --map.
void addGroundOptions(CLI::App& command, GroundOptions& options);

/// Declares what holds for any map: addLayerOptions, --soils, --soil, --model, --rover, --footprint and the
/// options of the policy.
void addGroundChoices(CLI::App& command, GroundOptions& options);

/// A built map, and what it took.
struct Ground {
  costmap::TraversabilityMap map;
  std::vector<std::string> files;  ///< that were read, for the record
  double load_s = 0.0;
  double build_s = 0.0;
};

/// Soil and rover that are assumed on a map where none is named, by its body.
std::pair<std::string, std::string> assumedGround(const maps::ElevationMap& map);

/// Reads and builds. A DEM that is itself a map made by `talus costmap` is taken as --map. @throws InputError
Ground readGround(const GroundOptions& options, const Context& context);

}  // namespace talus::cli
