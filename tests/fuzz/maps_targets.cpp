#include <cstdint>
#include <utility>

#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/numpy_raster.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

std::string numpy(const std::string& shape, std::size_t numbers) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(8 * numbers, '\0');
}

std::string little(std::uint32_t value, int bytes) {
  std::string out;
  for (int k = 0; k < bytes; ++k, value >>= 8U) out += static_cast<char>(value & 0xFFU);
  return out;
}

// The check of ZIP: CRC-32 with the reversed polynomial.
std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return ~crc;
}

// An archive of stored files, as numpy.savez writes it: each with its header, then the list of them.
std::string archive(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out, list;
  for (const auto& [name, bytes] : files) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const std::string about = little(20, 2) + little(0, 2) + little(0, 2) + little(0, 4) +
                              little(crc32(bytes), 4) + little(size, 4) + little(size, 4) +
                              little(static_cast<std::uint32_t>(name.size()), 2) + little(0, 2);
    list += "PK\x01\x02" + little(20, 2) + about + little(0, 10) +
            little(static_cast<std::uint32_t>(out.size()), 4) + name;
    out += "PK\x03\x04" + about + name + bytes;
  }
  const auto count = static_cast<std::uint32_t>(files.size());
  return out + list + "PK\x05\x06" + little(0, 4) + little(count, 2) + little(count, 2) +
         little(static_cast<std::uint32_t>(list.size()), 4) +
         little(static_cast<std::uint32_t>(out.size()), 4) + little(0, 2);
}

std::string numpyArchive() {
  const std::string zero = numpy("", 1),
                    one = zero.substr(0, zero.size() - 8) + std::string("\0\0\0\0\0\0\xf0\x3f", 8);
  return archive({{"elevation.npy", numpy("3, 3", 9)},
                  {"xmin.npy", zero},
                  {"xmax.npy", one},
                  {"ymin.npy", zero},
                  {"ymax.npy", one}});
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

void readNumpyArchive(const std::string& bytes) {
  maps::readElevation(fileOf(bytes, ".npz"), {.resolution_m = 10'000.0, .max_cells = 10'000});
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
      {"npy",
       {numpy("2, 3", 6), numpy("", 1)},
       [](const std::string& bytes) { maps::parseNumpy(bytes, "npy"); }},
      {"npz", {numpyArchive()}, readNumpyArchive},
  };
}

}  // namespace talus::fuzz
