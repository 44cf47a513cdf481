#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {

/// Writes siteLayers() as a GeoTIFF, with a QGIS style FILE.qml of the allowed headings. @throws InputError
void writeLayers(const costmap::TraversabilityMap& map, const std::string& path, int threads);

/// Writes the category of each cell in its worst heading as an integer GeoTIFF with category names, colour
/// table and overviews (coarser copies), and a QGIS style file. @throws InputError
void writeCategories(const costmap::TraversabilityMap& map, const std::string& path);

/// Writes a map for ROS map_server and Nav2: a YAML file and a PGM image. Safe cells, and marginal cells if
/// the map's policy permits them, are free. Dangerous cells, and other marginal cells, are occupied. Cells of
/// unknown category are unknown. Coordinates are those of the map [m]. @throws InputError
void writeNav2Map(const costmap::TraversabilityMap& map, const std::string& yaml);

/// Description of a file format for users, or of a mapping inside such a file.
struct FileFormat {
  std::string title;
  std::string about;  ///< description in one sentence
  std::span<const terramech::FileKey> keys;
};

/// Returns the descriptions of all file formats, with the keys that their readers accept.
std::vector<FileFormat> fileFormats();

/// Returns the output of `talus help formats`.
std::string formatsText();

}  // namespace talus::cli
