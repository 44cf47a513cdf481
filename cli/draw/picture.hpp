#pragma once

#include <filesystem>
#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// The scene as one PNG: hillshade under categories (or under the first value layer if there are no
/// categories), route, start, goal, scale bar, north arrow, legend, title.
std::string drawPicture(const Scene& scene);

/// Writes the picture; the file appears complete or not at all. @throws InputError when the file cannot be
/// written
void savePicture(const std::filesystem::path& path, const Scene& scene);

}  // namespace talus::cli
