#pragma once

#include <map>
#include <string>

namespace talus::terramech {

/// YAML texts of the built-in soils and rovers by name, generated from terramech/library/ at configuration.
const std::map<std::string, std::string>& librarySoilTexts();
const std::map<std::string, std::string>& libraryRoverTexts();

}  // namespace talus::terramech
