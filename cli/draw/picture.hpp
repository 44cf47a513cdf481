#pragma once

#include <filesystem>
#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// Returns the scene as a PNG file: a hillshade under the allowed headings (or under the first value layer if there
/// are none), with route, start, goal, scale bar, north arrow, legend and title.
std::string drawPicture(const Scene& scene);

/// Writes the picture to a file, which appears complete or not at all. @throws InputError if the file cannot
/// be written
void savePicture(const std::filesystem::path& path, const Scene& scene);

}  // namespace talus::cli
