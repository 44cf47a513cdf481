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

/// A DEM named by the user, and options for reading.
struct MapOptions {
  std::string path;
  std::string window;             ///< as entered
  std::optional<double> below_m;  ///< OctoMap only: uses ground at or below this height
  maps::ReadOptions read;
};

/// Declares --band, --resolution, --window, --nodata, --keep-zeros, --vertical-scale, --ignore-crs, --max-cells,
/// --allow-vrt, --below.
void addReadOptions(CLI::App& command, MapOptions& options);

/// Declares the positional DEM (or `name`) and the options of addReadOptions().
void addMapOptions(CLI::App& command, MapOptions& options, const std::string& name = "DEM");

/// Refuses raster reading options for an OctoMap or a built map, which have their own grid. @throws
/// InputError
void refuseReadOptions(const MapOptions& options);

/// Reads a map written by `talus costmap`. @throws InputError
costmap::TraversabilityMap readBuiltMap(const std::string& path, const Context& context);

/// Reads the map. Decisions of the reader are printed as warnings. @throws InputError
maps::ElevationMap readMap(const MapOptions& options, const Context& context);

/// An elevation map, and the other floors of an OctoMap's columns.
struct MapWithFloors {
  maps::ElevationMap elevation;
  std::vector<costmap::Floor> floors;
};
MapWithFloors readMapWithFloors(const MapOptions& options, const Context& context);

/// Layers over the DEM; an empty path means no layer.
struct LayerOptions {
  std::string terrain;  ///< class raster
  std::optional<int> terrain_band;
  std::string rocks;  ///< rock-abundance raster
  std::optional<int> rocks_band;
  std::vector<std::string> keep_out;  ///< vector files of polygons
  std::vector<std::string> costs;     ///< NAME=FILE: additional energy [J/m]
};

/// The layers on the map's grid; a raster is empty if the user named no file.
struct Layers {
  maps::Raster<std::uint8_t> classes;   ///< maps::kNoClass: no class
  maps::Raster<float> rock_abundance;   ///< NaN: no data
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: must not be entered
  std::vector<costmap::CostLayer> costs;
  std::vector<std::string> notes;  ///< warnings, each with its file
};

/// Declares --terrain, --terrain-band, --rocks, --rocks-band, --keep-out and --layer.
void addLayerOptions(CLI::App& command, LayerOptions& options);

/// Splits a layer given as NAME=FILE; the name consists of letters, digits, - and _. @throws InputError
std::pair<std::string, std::string> layerNamed(const std::string& given);

/// Reads the layers and aligns them with the map. If several classes meet in a cell, the class latest in
/// `weakest_last` is used. Cells without rock data become unknown in a cost layer named "rocks". @throws
/// InputError
Layers readLayers(const LayerOptions& options, const maps::ElevationMap& map,
                  std::span<const int> weakest_last = {});

}  // namespace talus::cli
