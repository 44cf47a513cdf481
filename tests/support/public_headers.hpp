#pragma once

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace talus::test {

/// Paths below the source folder of the headers that are installed: those that the modules' CMakeLists.txt list as
/// PUBLIC, talus.hpp and talus.h.
inline std::vector<std::string> publicHeaders(const std::string& source_folder) {
  std::vector<std::string> headers{"talus.hpp", "planner/c/talus.h"};
  const std::regex word(R"([^\s()]+)");
  for (const std::string module : {"common", "terramech", "maps", "costmap", "planner", "cli"}) {
    std::ifstream in(std::filesystem::path(source_folder) / module / "CMakeLists.txt");
    std::ostringstream read;
    read << in.rdbuf();
    const std::string list = read.str();
    bool is_public = false;
    for (std::sregex_iterator i(list.begin(), list.end(), word), end; i != end; ++i) {
      const std::string name = i->str();
      const bool header = name.ends_with(".hpp");
      is_public = name == "PUBLIC" || (is_public && header);
      if (is_public && header) headers.push_back(module + "/" + name);
    }
  }
  return headers;
}

}  // namespace talus::test
