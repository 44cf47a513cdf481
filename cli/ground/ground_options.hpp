#pragma once

#include <string>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/site/site.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Declares the options --band, --resolution, --window, --nodata, --keep-holes, --vertical-scale,
/// --ignore-crs, --max-cells, --allow-vrt and --below.
void addReadOptions(CLI::App& command, ElevationFile& file);

/// Declares the positional argument `name` (default DEM) and the options of addReadOptions().
void addMapOptions(CLI::App& command, ElevationFile& file, const std::string& name = "DEM");

/// Declares the options --terrain, --terrain-band, --rocks, --rocks-band, --keep-out and --layer.
void addLayerOptions(CLI::App& command, SiteFiles& files);

/// Returns how a command reads a site: assumptions and repairs are printed as warnings.
SiteReading readingOf(const Context& context);

}  // namespace talus::cli

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
