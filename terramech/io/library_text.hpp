#pragma once

#include <map>
#include <string>

namespace talus::terramech {

/// YAML texts of the built-in soils and rovers by name, made from terramech/library/ when the build is
/// configured.
const std::map<std::string, std::string>& librarySoilTexts();
const std::map<std::string, std::string>& libraryRoverTexts();

}  // namespace talus::terramech
