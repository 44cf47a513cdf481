#pragma once

#include <filesystem>
#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// The scene as one HTML page that needs no network and no other file: a map with zoom and layers, and for a
/// route its summary and the profiles of elevation, slope, slip and energy; pointing at a profile marks the
/// place on the map, and the reverse.
std::string page(const Scene& scene);

/// Writes the page, whole or not at all. @throws InputError when the file cannot be written
void savePage(const std::filesystem::path& path, const Scene& scene);

}  // namespace talus::cli
