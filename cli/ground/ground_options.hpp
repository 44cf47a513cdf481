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

/// Inputs of a traversability map: the files of a site, or a built map.
struct GroundOptions : SiteFiles {
  std::string
      map_file{};         ///< file of --map, which `talus costmap` wrote with its own layers, soils and rover
  std::string mission{};  ///< mission file that stated options of the call; empty: none

  /// Returns the files with map and mission in their manifest.
  SiteFiles files() const;
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

/// Returns a traversability map from its inputs. A DEM that is a file of `talus costmap` is treated like
/// --map. @throws InputError
Ground readGround(const GroundOptions& options, const Context& context);

}  // namespace talus::cli
