#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/help_format.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/ground/map_options.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/maps/raster/spatial_reference.hpp>
#include <talus/planner/plugin/layer_plugin.hpp>

namespace talus::cli {

void addMapOptions(CLI::App& command, MapOptions& options, const std::string& name) {
  command.add_option(name, options.path, "elevation map: any GDAL raster, a NumPy .npz, or an OctoMap")
      ->required();
  addReadOptions(command, options);
}

void addReadOptions(CLI::App& command, MapOptions& options) {
  maps::ReadOptions& read = options.read;
  command.add_option("--band", read.band, "band of elevations, counted from 1")->type_name("N");
  command
      .add_option("--resolution", read.resolution_m,
                  "cell size; required without a CRS; resamples with a CRS")
      ->type_name("METRES");
  command
      .add_option("--window", options.window,
                  "read only this window: x0,y0,x1,y1, or lat,lon,lat,lon with the suffix d on each")
      ->type_name("BOX");
  command.add_option("--nodata", read.nodata, "value of cells without data")->type_name("VALUE");
  command.add_flag("--keep-holes", read.keep_holes,
                   "leave single cells without data unknown instead of interpolating them");
  command
      .add_option("--vertical-scale", read.vertical_scale,
                  "factor on the heights; metres per unit where the file states an unknown one")
      ->type_name("FACTOR");
  command.add_flag("--ignore-crs", read.ignore_crs,
                   "ignore a wrong CRS and read as local metres (with --resolution)");
  command.add_flag("--allow-vrt", read.allow_vrt,
                   "read a virtual raster (VRT) whose files lie in its own folder");
  command
      .add_option("--below", options.below_m,
                  "of an OctoMap: use the ground at or below this elevation, as under a bridge")
      ->type_name("METRES");
  command.add_option("--max-cells", read.max_cells, "largest accepted map, in cells")
      ->type_name("N")
      ->check(within(1.0, 1e15))
      ->capture_default_str();
  groupOptions(command, "Elevation map");
}

void refuseReadOptions(const MapOptions& options) {
  const maps::ReadOptions& read = options.read;
  const std::pair<const char*, bool> given[] = {
      {"--band", read.band.has_value()},
      {"--resolution", read.resolution_m.has_value()},
      {"--window", !options.window.empty()},
      {"--nodata", read.nodata.has_value()},
      {"--keep-holes", read.keep_holes},
      {"--vertical-scale", read.vertical_scale.has_value()},
      {"--ignore-crs", read.ignore_crs},
      {"--max-cells", read.max_cells != maps::ReadOptions{}.max_cells}};
  for (const auto& [name, present] : given)
    if (present)
      throw InputError({options.path,
                        std::string("has a grid of its own, on which ") + name + " has no effect",
                        std::string("remove ") + name});
}

costmap::TraversabilityMap readBuiltMap(const std::string& path, const Context& context) {
  return costmap::readMap({.name = path, .threads = context.workers(), .georeference = maps::georeferenceOn},
                          context.watch("read map"));
}

namespace {

maps::ElevationMap fromOctomap(const MapOptions& options, const std::string& type, const Context& context) {
  refuseReadOptions(options);
  if (type == "TraversabilityTree" && options.below_m)
    throw InputError({options.path, "--below selects a level of a point cloud, and this is a built map",
                      "give --below to talus costmap"});
  if (type == "TraversabilityTree") return readBuiltMap(options.path, context).elevation();
  return costmap::octomapGround(options.path,
                                options.below_m.value_or(std::numeric_limits<double>::infinity()));
}

}  // namespace

maps::ElevationMap readMap(const MapOptions& options, const Context& context) {
  if (const auto type = costmap::octomapType(options.path)) return fromOctomap(options, *type, context);
  if (options.below_m)
    throw InputError(
        {options.path, "--below selects a level of an OctoMap, and this is a raster", "remove --below"});
  maps::ReadOptions read = options.read;
  if (!options.window.empty()) read.window = maps::parseWindow(options.window);
  const ProgressMonitor reading = context.watch("read map");
  maps::ElevationMap map = maps::readElevation(options.path, read);
  // memory of beliefs, hazards, curves, tiles and their working copies
  constexpr double kBytesPerCell = 40.0;
  requireMemory(kBytesPerCell * static_cast<double>(map.elevation_m.values().size()), options.path);
  for (const std::string& note : map.notes) context.warn(options.path + ": " + note);
  return map;
}

void addLayerOptions(CLI::App& command, LayerOptions& options) {
  command.add_option("--terrain", options.terrain, "raster of terrain classes")->type_name("FILE");
  command.add_option("--terrain-band", options.terrain_band, "band of the raster, counted from 1")
      ->type_name("N");
  command.add_option("--rocks", options.rocks, "raster of rock abundance, 0 to 1")->type_name("FILE");
  command.add_option("--rocks-band", options.rocks_band, "band of the raster, counted from 1")
      ->type_name("N");
  command
      .add_option("--keep-out", options.keep_out, "polygons of a vector file to keep out of; may be repeated")
      ->type_name("FILE");
  command
      .add_option(
          "--layer", options.costs,
          "joules a metre to add, as NAME=FILE of a raster or a layer plugin (.so): inf is refused, no data "
          "counts as unknown; may be repeated")
      ->type_name("NAME=FILE");
  groupOptions(command, "Layers");
}

std::pair<std::string, std::string> layerNamed(const std::string& given) {
  const std::size_t end = given.find('=');
  const std::string name = given.substr(0, end == std::string::npos ? 0 : end);
  const auto word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  if (name.empty() || end + 1 == given.size() || !std::ranges::all_of(name, word))
    throw InputError({"--layer " + given, "is not NAME=FILE with a name of letters, digits, - and _",
                      "write --layer shadow=shadow.tif"});
  return {name, given.substr(end + 1)};
}

namespace {

costmap::CostLayer costLayer(const std::string& given, const maps::ElevationMap& map) {
  const auto [name, path] = layerNamed(given);
  if (path.ends_with(".so")) return planner::layerFrom(path, name, map.grid());
  maps::AddedJoules added = maps::readAddedJoules({path, {}}, map);
  return {.name = name, .added_J_per_m = std::move(added.J_per_m), .unseen_J_per_m = added.highest_J_per_m};
}

// Cells without rock data become unknown ground (NaN); if unknown ground is permitted, such cells
// cost no extra energy.
costmap::CostLayer unseenRocks(const maps::Raster<std::uint8_t>& unseen) {
  costmap::CostLayer layer{.name = "rocks", .added_J_per_m = maps::Raster<float>(unseen.grid())};
  std::ranges::transform(unseen.values(), layer.added_J_per_m.values().begin(), [](std::uint8_t hidden) {
    return hidden != 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
  });
  return layer;
}

}  // namespace

Layers readLayers(const LayerOptions& options, const maps::ElevationMap& map,
                  std::span<const int> weakest_last) {
  Layers layers;
  if (!options.terrain.empty())
    layers.classes = maps::readTerrainClasses({options.terrain, options.terrain_band}, map, weakest_last);
  if (!options.rocks.empty()) {
    maps::RockAbundance rocks = maps::readRockAbundance({options.rocks, options.rocks_band}, map);
    layers.rock_abundance = std::move(rocks.share);
    if (std::ranges::count(rocks.unseen.values(), 0) != std::ssize(rocks.unseen.values()))
      layers.costs.push_back(unseenRocks(rocks.unseen));
  }
  for (const std::string& path : options.keep_out) {
    const auto [mask, notes] = maps::readKeepOut(path, map);
    for (const std::string& note : notes) layers.notes.push_back(path + ": " + note);
    if (layers.keep_out.empty()) layers.keep_out = maps::Raster<std::uint8_t>(map.grid());
    for (std::size_t i = 0; i < mask.values().size(); ++i) layers.keep_out.values()[i] |= mask.values()[i];
  }
  for (const std::string& given : options.costs) {
    layers.costs.push_back(costLayer(given, map));
    for (std::size_t i = 0; i + 1 < layers.costs.size(); ++i)
      if (layers.costs[i].name == layers.costs.back().name)
        throw InputError(
            {"--layer " + given, "a layer of that name is given already", "give each its own name"});
  }
  return layers;
}

}  // namespace talus::cli
