#pragma once

#include <filesystem>
#include <string>

#include <talus/costmap/map/traversability_map.hpp>

namespace talus::cli {

/// The style for QGIS that lies beside a GeoTIFF of categories.
std::filesystem::path categoryStyle(const std::filesystem::path& tif);

/// Writes the category of each cell, of the worst heading, as a GeoTIFF of whole numbers with names, a colour table and
/// overviews, and its style for QGIS. @throws InputError
void writeCategories(const costmap::TraversabilityMap& map, const std::string& path);

/// The picture of a map of ROS' map_server that lies beside its YAML file.
std::filesystem::path nav2Picture(const std::filesystem::path& yaml);

/// Writes a map of ROS' map_server, for Nav2: the YAML file and its PGM. Safe cells are free, marginal ones where the map's
/// policy allows them, dangerous ones occupied, the rest unknown; its metres are those of the map. @throws InputError
void writeNav2Map(const costmap::TraversabilityMap& map, const std::string& yaml);

}  // namespace talus::cli
