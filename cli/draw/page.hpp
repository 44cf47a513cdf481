#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns the HTML page without its data, assembled at build time from cli/page/, Leaflet and Vega. It has
/// the place-holders @TALUS_TITLE@, @TALUS_TEXT@ and @TALUS_DATA@ in this order.
std::string_view pageTemplate();

/// Returns the page of a Report without its data, of Vega and cli/page/report.js, with the same place-holders.
std::string_view reportTemplate();

/// Returns the text with characters escaped that HTML reads as markup.
std::string escaped(const std::string& text);

/// Returns a template with title, HTML text and data in place of its place-holders. "<" in the data is escaped.
std::string filledPage(std::string_view empty, const std::string& title, const std::string& text,
                       const nlohmann::ordered_json& data);

/// Returns the scene as one self-contained HTML page: a map with zoom and layers and, for a route, its
/// summary and profiles of elevation, slope, slip and energy. Hovering over a profile marks the position on
/// the map, and vice versa.
std::string page(const Scene& scene);

/// Writes the scene as a page and as a PNG picture, each to a file that appears complete or not at all; nothing for an
/// empty path. @throws InputError if a file cannot be written
void saveScene(const Scene& scene, const std::filesystem::path& html, const std::filesystem::path& png);

}  // namespace talus::cli
