#pragma once

#include <map>
#include <string>

namespace talus::terramech {

/// Return the YAML texts of the built-in soils and rovers by name, generated from terramech/library/ when
/// CMake configures the build.
const std::map<std::string, std::string>& librarySoilTexts();
const std::map<std::string, std::string>& libraryRoverTexts();

}  // namespace talus::terramech
