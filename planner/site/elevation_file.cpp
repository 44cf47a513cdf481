#include <limits>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/maps/raster/spatial_reference.hpp>
#include <talus/planner/site/elevation_file.hpp>

namespace talus {

void refuseReadOptions(const ElevationFile& file) {
  const maps::ReadOptions& read = file.read;
  const std::pair<const char*, bool> given[] = {
      {"--band", read.band.has_value()},  {"--resolution", read.resolution_m.has_value()},
      {"--window", !file.window.empty()}, {"--nodata", read.nodata.has_value()},
      {"--keep-holes", read.keep_holes},  {"--vertical-scale", read.vertical_scale.has_value()},
      {"--ignore-crs", read.ignore_crs},  {"--max-cells", read.max_cells != maps::ReadOptions{}.max_cells}};
  for (const auto& [name, present] : given)
    if (present)
      throw InputError({file.path, std::string("has a grid of its own, on which ") + name + " has no effect",
                        std::string("remove ") + name});
}

costmap::TraversabilityMap readBuiltMap(const std::string& path, const SiteReading& reading) {
  return costmap::readMap({.name = path, .threads = reading.threads, .georeference = maps::georeferenceOn},
                          reading.watch);
}

maps::ElevationMap readMap(const ElevationFile& file, const SiteReading& reading) {
  if (const auto type = costmap::octomapType(file.path)) {
    refuseReadOptions(file);
    if (*type != "TraversabilityTree")
      return costmap::octomapGround(file.path,
                                    file.below_m.value_or(std::numeric_limits<double>::infinity()));
    if (file.below_m)
      throw InputError({file.path, "--below selects a level of a point cloud, and this is a built map",
                        "give --below to talus costmap"});
    return readBuiltMap(file.path, reading).elevation();
  }
  if (file.below_m)
    throw InputError(
        {file.path, "--below selects a level of an OctoMap, and this is a raster", "remove --below"});
  maps::ReadOptions read = file.read;
  if (!file.window.empty()) read.window = maps::parseWindow(file.window);
  maps::ElevationMap map = maps::readElevation(file.path, read);
  // memory of beliefs, hazards, curves, tiles and their working copies
  constexpr double kBytesPerCell = 40.0;
  requireMemory(kBytesPerCell * static_cast<double>(map.elevation_m.values().size()), file.path);
  for (const std::string& note : map.notes) reading.tell(file.path + ": " + note);
  return map;
}

}  // namespace talus
