#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace talus::architecture {

/// Files below a folder of the project with one of the endings, sorted, so that messages are reproducible.
inline std::vector<std::filesystem::path> files(const std::string& folder,
                                                const std::vector<std::string>& endings) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TALUS_SOURCE_DIR "/" + folder))
    for (const auto& ending : endings)
      if (entry.is_regular_file() && entry.path().extension() == ending) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// All Markdown documents: those in the source folder and in the listed folders; sorted.
inline std::vector<std::filesystem::path> documents() {
  std::vector<std::filesystem::path> found;
  for (const std::string folder :
       {"docs", "common", "terramech", "maps", "costmap", "planner", "cli", "examples", "tests"})
    for (const auto& file : files(folder, {".md"})) found.push_back(file);
  for (const auto& entry : std::filesystem::directory_iterator(TALUS_SOURCE_DIR))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

inline std::string text(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace talus::architecture
