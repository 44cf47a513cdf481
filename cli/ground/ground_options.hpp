#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/site/site.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Returns the layers of a map as GeoTIFF bands: elevation, slope, aspect, roughness, step, class, category
/// (of the worst heading), allowed_headings (AllowedHeadings), drawbar_pull_over_load, drawbar_pull_over_load_std,
/// sinkage_over_radius, energy_per_metre_uphill, energy_per_metre_downhill. Units are SI and radians; NaN:
/// unknown. Categories are 0 safe, 1 marginal, 2 dangerous, 3 unknown; cells with a hazard are dangerous.
std::vector<maps::Layer> siteLayers(const costmap::TraversabilityMap& map, int threads);

/// Declares the options --band, --resolution, --window, --nodata, --keep-holes, --vertical-scale,
/// --ignore-crs, --max-cells, --allow-vrt and --below.
void addReadOptions(CLI::App& command, ElevationFile& file);

/// Declares the positional argument `name` (default DEM) and the options of addReadOptions().
void addMapOptions(CLI::App& command, ElevationFile& file, const std::string& name = "DEM");

/// Returns how a command reads a site: assumptions and repairs are printed as warnings.
SiteReading readingOf(const Context& context);

/// Inputs of a traversability map: the files of a site, or a built map.
struct GroundOptions : SiteFiles {
  std::string
      map_file{};         ///< file of --map, which `talus costmap` wrote with its own layers, soils and rover
  std::string mission{};  ///< mission file that stated options of the call; empty: none
  /// The parsed call whose options are bound to this object; null: none.
  CLI::App* call = nullptr;

  /// Returns the files with map and mission in their manifest.
  SiteFiles files() const;
};

/// Declares the option --map and the options of addMapOptions() and addGroundChoices(). The positional argument may
/// also be a mission: readMission().
void addGroundOptions(CLI::App& command, GroundOptions& options);

/// Declares the options that apply to any map: layers, --soils, --soil, --model, --rover,
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

/// Returns true if the options state an elevation map (DEM) with more than `cells` cells; false for built
/// maps and OctoMaps.
bool needsWindows(const GroundOptions& options, std::size_t cells);

/// Returns the whole ground of the DEM, resampled to about two million cells. @throws InputError
Ground readOverview(const GroundOptions& options, const Context& context);

/// Returns the ground at full resolution as a map that is read window by window. `overview` is the result of
/// readOverview(). @throws InputError
planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context);

/// Returns a polyline in map coordinates [m] from a file: the first line of a vector file, or a CSV table
/// whose columns x_m and y_m (also x and y, easting and northing: map metres) or lat and lon (degrees of the map's
/// georeference, WGS 84 on Earth) are named in any case. The polyline has at least one point. A route file of `talus plan` gives the
/// exact values of its properties x_m, y_m. Coordinates of such a file that differ from these properties by
/// more than a tenth of a cell were edited and are rejected. @throws InputError
std::vector<maps::Point> readPath(const std::string& path, const maps::ElevationMap& map);

}  // namespace talus::cli
