#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns the HTML page without its data, assembled at build time from cli/page/, Leaflet and Vega. It has
/// the place-holders @TALUS_TITLE@, @TALUS_SUBTITLE@ and @TALUS_DATA@ in this order.
std::string_view pageTemplate();

/// Returns the scene as one self-contained HTML page: a map with zoom and layers and, for a route, its
/// summary and profiles of elevation, slope, slip and energy. Hovering over a profile marks the position on
/// the map, and vice versa.
std::string page(const Scene& scene);

/// Writes the page to a file, which appears complete or not at all. @throws InputError if the file cannot be
/// written
void savePage(const std::filesystem::path& path, const Scene& scene);

}  // namespace talus::cli
