#include <cstdint>
#include <utility>

#include <talus/maps/maps_io.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

std::string little(std::uint32_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k, value >>= 8U) out += static_cast<char>(value & 0xFFU);
  return out;
}

// A TIFF of 4 x 4 floats in cells of a metre.
std::string tiff() {
  constexpr std::uint32_t kTags[][4] = {{256, 3, 1, 4}, {257, 3, 1, 4},      {258, 3, 1, 32},
                                        {259, 3, 1, 1}, {262, 3, 1, 1},      {273, 4, 1, 8},
                                        {277, 3, 1, 1}, {278, 3, 1, 4},      {279, 4, 1, 64},
                                        {339, 3, 1, 3}, {33550, 12, 3, 222}, {33922, 12, 6, 246}};
  std::string bytes = "II*" + std::string(1, '\0') + little(72, 4) + std::string(64, '\x40') + little(12, 2);
  for (const auto& [tag, type, count, value] : kTags)
    bytes += little(tag, 2) + little(type, 2) + little(count, 4) + little(value, 4);
  bytes.resize(222, '\0');
  for (int k = 0; k < 2; ++k) bytes += std::string(6, '\0') + "\xf0\x3f";
  return bytes + std::string(56, '\0');
}

void readRaster(const std::string& bytes) {
  maps::readElevation(fileOf(bytes, ".dat"), {.resolution_m = 1.0, .ignore_crs = true, .max_cells = 10'000});
}

void readGeoJson(const std::string& bytes) {
  const std::string path = fileOf(bytes, ".geojson");
  maps::readKeepOut(path, flatMap());
}

void readVectorFile(const std::string& bytes) {
  maps::ElevationMap map = flatMap();
  map.georeference.emplace(maps::CoordinateSystem{.name = "around 0,0", .ellipsoid = maps::kEarth});
  maps::readKeepOut(fileOf(bytes, ".kml"), map);
}

}  // namespace

std::vector<Target> mapsTargets() {
  return {
      {"geojson",
       {R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[1,1],[5,1],[5,5],[1,1]]]}}]})",
        R"({"type":"GeometryCollection","geometries":[{"type":"MultiPolygon","coordinates":[[[[1,1],[9,1],[9,9],[1,1]]]]}]})"},
       readGeoJson},
      {"vector",
       {R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><Polygon><outerBoundaryIs>)"
        R"(<LinearRing><coordinates>0.00001,0.00001 0.00005,0.00001 0.00005,0.00005 0.00001,0.00001</coordinates>)"
        R"(</LinearRing></outerBoundaryIs></Polygon></Placemark>)"
        R"(</Document></kml>)"},
       readVectorFile,
       {R"(<?xml version="1.0"?><gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><wpt lat="1" lon="2"/></gpx>)"}},
      {"raster",
       {tiff(),
        "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n1 2 3\n4 5 -9999\n"},
       readRaster},
  };
}

}  // namespace talus::fuzz
