#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/maps/maps.hpp>

namespace talus::maps {

/// A position in map coordinates [m]; elevation_m is NaN if unknown.
struct VectorPosition {
  Point at{};
  double elevation_m = 0.0;
};

/// A feature of a vector file: a point, a line of at least two positions, or a row without positions, with fields
/// of type text, number (NaN and null: no value) or Boolean.
struct VectorFeature {  // NOLINT(bugprone-exception-escape): moving ordered_json does not throw
  std::vector<VectorPosition> positions;
  nlohmann::ordered_json fields;
};

/// A layer of a vector file. The first feature determines the names and types of the fields.
struct VectorLayer {
  std::string name;
  std::vector<VectorFeature> features;
};

/// Checks that GDAL's driver (file format) can store the map. @throws InputError for GPX and KML if the map
/// has no body or a body other than Earth
void requireWritable(const std::string& driver, const ElevationMap& map, const std::string& path);

/// Returns the bytes of a vector file of GDAL's driver (GPKG, GPX, KML). GPX and KML use WGS 84 longitude and
/// latitude; GPKG uses the CRS of the map. GPX stores the fields `name` and `desc` only. A GeoPackage also
/// stores the text `document`, which storedDocument() reads. Equal input gives equal bytes. @throws
/// InputError in the cases of requireWritable()
std::string vectorFile(const std::string& driver, const ElevationMap& map,
                       const std::vector<VectorLayer>& layers, const std::string& path,
                       const std::string& document = "");

/// Returns the bytes of a GeoPackage with the cells of a raster that are not 0, as polygons in the CRS of the map.
/// @throws InputError for a path that does not end with .gpkg
std::string areaFile(const ElevationMap& map, const Raster<std::uint8_t>& inside, const std::string& name,
                     const std::string& path);

/// Content of a GeoPackage: the stored document, and the positions of the first line of the first layer.
struct StoredDocument {
  std::string document;
  std::vector<Point> line;
};
/// Returns the stored document of a GeoPackage. @throws InputError if the file is missing, damaged, or
/// without a document
StoredDocument storedDocument(const std::string& path);

}  // namespace talus::maps
