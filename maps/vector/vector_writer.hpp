#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A position in map coordinates [m]; the elevation may be NaN.
struct VectorPosition {
  Point at{};
  double elevation_m = 0.0;
};

/// A point, or a line of at least two positions, with fields of type text, number (NaN and null: no value) or
/// Boolean.
struct VectorFeature {  // NOLINT(bugprone-exception-escape): moving ordered_json does not throw
  std::vector<VectorPosition> positions;
  nlohmann::ordered_json fields;
};

/// A layer; the first feature determines the fields.
struct VectorLayer {
  std::string name;
  std::vector<VectorFeature> features;
};

/// Refuses GPX and KML for maps without a body or of a body other than Earth. @throws InputError
void requireWritable(const std::string& driver, const ElevationMap& map, const std::string& path);

/// Returns a vector file of GDAL's driver (GPKG, GPX, KML): in the CRS of the map, or in WGS 84 longitude and
/// latitude for GPX and KML. GPX stores the fields `name` and `desc` only. A GeoPackage also stores
/// `document`, for storedDocument(). Equal input gives equal bytes. @throws InputError as requireWritable()
std::string vectorFile(const std::string& driver, const ElevationMap& map,
                       const std::vector<VectorLayer>& layers, const std::string& path,
                       const std::string& document = "");

/// The stored document of a GeoPackage, and the positions of the first line of its first layer.
struct StoredDocument {
  std::string document;
  std::vector<Point> line;
};
/// Reads the document. @throws InputError: no such file, damaged, or without a document
StoredDocument storedDocument(const std::string& path);

}  // namespace talus::maps
