#pragma once

#include <optional>
#include <string>
#include <vector>

#include <cli/map_options.hpp>
#include <costmap/traversability_map.hpp>

namespace talus::cli {

/// How the user describes a site: the DEM and its layers, what drives there, what the ground is and what is
/// allowed.
struct SiteOptions {
  MapOptions map;
  LayerOptions layers;
  std::string map_file;             ///< MAP.ot to go on from; then the layers, soils and rover are its own
  std::string rover;                ///< library name or YAML; empty: one that suits the body
  std::string soil;                 ///< of ground without a class; empty: one that suits the body
  std::string soils;                ///< YAML of the terrain classes
  double footprint_radius_m = 0.0;  ///< 0: half the rover's diagonal
  costmap::DrivePolicy policy;
};

/// A site ready to plan on.
struct Site {
  costmap::TraversabilityMap map;
  std::vector<std::string> inputs;  ///< files that it was made from
  double load_s = 0.0;              ///< reading files
  double costmap_s = 0.0;           ///< building the map
};

/// Declares DEM and its reading options, --terrain, --rocks, --keep-out, --map, --rover, --soil, --soils,
/// --footprint and the policy.
void addSiteOptions(CLI::App& command, SiteOptions& options);

/// Reads and builds the site. The DEM may be a MAP.ot itself, or a point-cloud OctoMap. Throws InputError.
Site buildSite(const SiteOptions& options, const Context& context);

}  // namespace talus::cli
