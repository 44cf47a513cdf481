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

/// A DEM as named by the user, and how to read it.
struct MapOptions {
  std::string path;
  std::string window;             ///< as typed
  std::optional<double> below_m;  ///< of an OctoMap: the ground at or below this height
  maps::ReadOptions read;
};

/// Declares --band, --resolution, --window, --nodata, --keep-zeros, --vertical-scale, --ignore-crs, --max-cells,
/// --allow-vrt, --below.
void addReadOptions(CLI::App& command, MapOptions& options);

/// Declares the positional DEM (or what `name` calls it) and addReadOptions().
void addMapOptions(CLI::App& command, MapOptions& options, const std::string& name = "DEM");

/// Refuses what says how to read a raster: an OctoMap and a built map bring their own grid. @throws InputError
void refuseReadOptions(const MapOptions& options);

/// Reads a map that `talus costmap` wrote. @throws InputError
costmap::TraversabilityMap readBuiltMap(const std::string& path, const Context& context);

/// Reads the map; what the reader decided goes to stderr as warnings. @throws InputError
maps::ElevationMap readMap(const MapOptions& options, const Context& context);

/// The same, and the other floors of an OctoMap's columns.
struct MapWithFloors {
  maps::ElevationMap elevation;
  std::vector<costmap::Floor> floors;
};
MapWithFloors readMapWithFloors(const MapOptions& options, const Context& context);

/// Layers that lie over the DEM; an empty path means none.
struct LayerOptions {
  std::string terrain;  ///< class raster
  std::optional<int> terrain_band;
  std::string rocks;  ///< rock-abundance raster
  std::optional<int> rocks_band;
  std::vector<std::string> keep_out;  ///< vector files of polygons
  std::vector<std::string> costs;     ///< NAME=FILE: joules a metre on top
};

/// The layers on the map's grid; a raster is empty where the user named no file.
struct Layers {
  maps::Raster<std::uint8_t> classes;   ///< maps::kNoClass where there is none
  maps::Raster<float> rock_abundance;   ///< NaN where there is none
  maps::Raster<std::uint8_t> keep_out;  ///< not 0: must not be entered
  std::vector<costmap::CostLayer> costs;
  std::vector<std::string> notes;  ///< warnings, each with its file
};

/// Declares --terrain, --terrain-band, --rocks, --rocks-band, --keep-out and --layer.
void addLayerOptions(CLI::App& command, LayerOptions& options);

/// The file of a layer given as NAME=FILE; the name is letters, digits, - and _. @throws InputError
std::pair<std::string, std::string> layerNamed(const std::string& given);

/// Reads and aligns them. Where classes meet in a cell the one latest in `weakest_last` counts. Rocks without data become a
/// cost layer "rocks" that knows nothing there. @throws InputError
Layers readLayers(const LayerOptions& options, const maps::ElevationMap& map,
                  std::span<const int> weakest_last = {});

}  // namespace talus::cli
