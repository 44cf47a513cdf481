#pragma once

#include <filesystem>
#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// The scene as one self-contained HTML page: a map with zoom and layers and, for a route, its summary and
/// profiles of elevation, slope, slip and energy. Hovering over a profile marks the place on the map, and
/// vice versa.
std::string page(const Scene& scene);

/// Writes the page; the file appears complete or not at all. @throws InputError when the file cannot be
/// written
void savePage(const std::filesystem::path& path, const Scene& scene);

}  // namespace talus::cli
