#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/layer_reader.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Elevation map (DEM) that the user states, and options for reading it.
struct MapOptions {
  std::string path;
  std::string window;             ///< text of --window, as entered
  std::optional<double> below_m;  ///< for an OctoMap only: ground above this height is not used
  maps::ReadOptions read;
};

/// Declares the options --band, --resolution, --window, --nodata, --keep-holes, --vertical-scale,
/// --ignore-crs, --max-cells, --allow-vrt and --below.
void addReadOptions(CLI::App& command, MapOptions& options);

/// Declares the positional argument `name` (default DEM) and the options of addReadOptions().
void addMapOptions(CLI::App& command, MapOptions& options, const std::string& name = "DEM");

/// Checks that no options for reading rasters are given for an OctoMap or a built map, which have their own
/// grid. @throws InputError otherwise
void refuseReadOptions(const MapOptions& options);

/// Returns a traversability map that `talus costmap` wrote. @throws InputError
costmap::TraversabilityMap readBuiltMap(const std::string& path, const Context& context);

/// Returns the elevation map. Decisions of the reader are printed as warnings. @throws InputError
maps::ElevationMap readMap(const MapOptions& options, const Context& context);

/// Files of the layers in addition to the elevation map; an empty path means no layer.
struct LayerOptions {
  std::string terrain;  ///< raster of terrain classes
  std::optional<int> terrain_band;
  std::string rocks;  ///< raster of rock abundance
  std::optional<int> rocks_band;
  std::vector<std::string> keep_out;  ///< vector files with keep-out polygons
  std::vector<std::string> costs;     ///< layers NAME=FILE with additional energy [J/m]
};

/// Layers on the grid of the map; a raster is empty if the user stated no file.
struct Layers {
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers; maps::kNoClass: no class
  maps::Raster<float> rock_abundance;   ///< fraction of the area covered by rocks; NaN: no data [-]
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: the cell must not be entered
  std::vector<costmap::CostLayer> costs;
  std::vector<std::string> notes;  ///< warnings, each with the file to which it refers
};

/// Declares the options --terrain, --terrain-band, --rocks, --rocks-band, --keep-out and --layer.
void addLayerOptions(CLI::App& command, LayerOptions& options);

/// Returns name and file of a layer given as NAME=FILE; the name consists of letters, digits, - and _.
/// @throws InputError
std::pair<std::string, std::string> layerNamed(const std::string& given);

/// Reads the layers and aligns them with the map. If several classes meet in a cell, the weakest class is
/// used, by the order of maps::readTerrainClasses() with `weakest_last`. Cells without rock data become
/// unknown in a cost layer named "rocks". @throws InputError
Layers readLayers(const LayerOptions& options, const maps::ElevationMap& map,
                  std::span<const int> weakest_last = {});

}  // namespace talus::cli
