#pragma once

#include <functional>
#include <string>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus::fuzz {

/// A reader of bytes from elsewhere. It may refuse them by the exceptions that the program turns into exit 2; all else
/// that ends it is a fault.
struct Target {
  std::string name;
  std::vector<std::string> seeds;  ///< that it accepts
  std::function<void(const std::string&)> read;
  std::vector<std::string> refused_seeds{};  ///< that it refuses for what stands deep inside
};

/// Readers by module: telemetry and YAML; GeoJSON and rasters; MAP.ot, octrees and journals; MovingAI files and
/// plugins; options, missions, truths, paths and routes.
std::vector<Target> terramechTargets();
std::vector<Target> mapsTargets();
std::vector<Target> costmapTargets();
std::vector<Target> plannerTargets();
std::vector<Target> cliTargets();

/// Whether the target accepts the bytes; false where it refuses them by an error of input.
bool accepts(const Target& target, const std::string& bytes);

/// A file with these bytes, of this process and the ending, over the one before.
std::string fileOf(const std::string& bytes, const std::string& ending);

/// What a target may take as memory, as --max-memory has it: few bytes of a file can state much, and what is within the
/// budget is computed.
void limitMemory();

/// A level map of 20 x 20 cells of a metre.
inline maps::ElevationMap flatMap() {
  maps::ElevationMap map;
  map.elevation_m =
      maps::Raster<float>({.width = 20, .height = 20, .resolution_m = 1.0, .south_west = {0, 0}}, 0.0F);
  return map;
}

}  // namespace talus::fuzz
