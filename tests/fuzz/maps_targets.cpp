#include <talus/maps/elevation_reader.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/numpy_array.hpp>
#include <talus/talus.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

std::string numpy(const std::string& shape, std::size_t numbers) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(8 * numbers, '\0');
}

maps::ElevationMap flat() {
  maps::ElevationMap map;
  map.elevation_m =
      maps::Raster<float>({.width = 20, .height = 20, .resolution_m = 1.0, .south_west = {0, 0}}, 0.0F);
  return map;
}

void readGeoJson(const std::string& bytes) {
  const std::string path = fileOf(bytes, ".geojson");
  maps::readKeepOut(path, flat());
}

void readNumpyArchive(const std::string& bytes) {
  maps::readElevation(fileOf(bytes, ".npz"), {.resolution_m = 1.0, .max_cells = 10'000});
}

}  // namespace

std::vector<Target> mapsTargets() {
  return {
      {"geojson",
       {R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[1,1],[5,1],[5,5],[1,1]]]}}]})",
        R"({"type":"GeometryCollection","geometries":[{"type":"MultiPolygon","coordinates":[[[[1,1],[9,1],[9,9],[1,1]]]]}]})"},
       readGeoJson},
      {"npy",
       {numpy("2, 3", 6), numpy("", 1)},
       [](const std::string& bytes) { maps::parseNumpy(bytes, "npy"); }},
      {"npz", {}, readNumpyArchive},
  };
}

}  // namespace talus::fuzz
