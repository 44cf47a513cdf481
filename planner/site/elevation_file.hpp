#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/maps/raster/elevation_reader.hpp>

namespace talus {

/// File of an elevation map, and options for reading it.
struct ElevationFile {
  ElevationFile() = default;
  ElevationFile(std::string file) : path(std::move(file)) {}
  ElevationFile(const char* file) : path(file) {}

  std::string path;  ///< raster, NumPy .npz or OctoMap
  std::string
      window{};  ///< part of the raster: "x0,y0,x1,y1", or "lat,lon,lat,lon" with the suffix d on each
  std::optional<double> below_m{};  ///< for an OctoMap only: ground above this height is not used
  maps::ReadOptions read{};
};

/// How files are read, and what is told meanwhile.
struct SiteReading {
  int threads = 1;                               ///< number of threads, >= 1
  std::function<void(std::string_view)> note{};  ///< receives assumptions and repairs, one line each
  ProgressMonitor watch{};
  void tell(std::string_view line) const {
    if (note) note(line);
  }
};

/// Returns the elevation map, also that of a file of `talus costmap`. @throws InputError
maps::ElevationMap readMap(const ElevationFile& file, const SiteReading& reading = {});

/// Returns the map of a file of `talus costmap`, with latitude and longitude by PROJ. @throws InputError
costmap::TraversabilityMap readBuiltMap(const std::string& path, const SiteReading& reading = {});

/// Checks that no options for reading rasters are given for an OctoMap or a built map, which have their own
/// grid. @throws InputError otherwise
void refuseReadOptions(const ElevationFile& file);

}  // namespace talus
