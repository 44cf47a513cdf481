#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A position in map metres; its elevation may be NaN.
struct VectorPosition {
  Point at{};
  double elevation_m = 0.0;
};

/// A point, or a line of two positions and more, with its fields: words, numbers (NaN and null: none) and yes or no.
struct VectorFeature {  // NOLINT(bugprone-exception-escape): moving ordered_json does not throw
  std::vector<VectorPosition> positions;
  nlohmann::ordered_json fields;
};

/// Features that have the fields of the first of them.
struct VectorLayer {
  std::string name;
  std::vector<VectorFeature> features;
};

/// Refuses a place of another body than Earth, or of none, as GPX or KML. @throws InputError
void requireWritable(const std::string& driver, const ElevationMap& map, const std::string& path);

/// A vector file as GDAL's driver (GPKG, GPX, KML) writes it: in the map's CRS, or for GPX and KML in longitude and latitude
/// of WGS 84. GPX keeps of the fields `name` and `desc`. A GeoPackage has `document`, for storedDocument(). Same layers, same
/// bytes. @throws InputError as requireWritable()
std::string vectorFile(const std::string& driver, const ElevationMap& map,
                       const std::vector<VectorLayer>& layers, const std::string& path,
                       const std::string& document = "");

/// That document of a GeoPackage, and the positions of the first line of its first layer, as they stand.
struct StoredDocument {
  std::string document;
  std::vector<Point> line;
};
/// @throws InputError: no such file, damaged, without a document
StoredDocument storedDocument(const std::string& path);

}  // namespace talus::maps
