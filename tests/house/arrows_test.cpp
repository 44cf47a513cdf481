// The rooms stand on each other in one direction only; an include that points the other way fails here by
// name.
#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::house {
namespace arrows_test {

using Rooms = std::map<std::string, std::set<std::string>>;

const Rooms& roomsBelow() {
  static const Rooms below{{"common", {}},
                           {"terramech", {"common"}},
                           {"maps", {"common"}},
                           {"costmap", {"common", "terramech", "maps"}},
                           {"planner", {"common", "terramech", "maps", "costmap"}},
                           {"cli", {"common", "terramech", "maps", "costmap", "planner"}}};
  return below;
}

TEST(House, NoRoomIncludesOneAboveIt) {
  const std::regex include(R"(#include <talus/(common|terramech|maps|costmap|planner|cli)/)");
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i) {
        const std::string other = (*i)[1];
        EXPECT_TRUE(other == room || below.contains(other)) << file << " includes <" << other << "/...>";
      }
    }
}

// The folder of a path below the source folder or of an include: "room" or "room/part", or deeper.
std::string partOf(const std::string& path) {
  return path.substr(0, path.rfind('/'));
}

Rooms partsIncluded() {
  const std::regex include(R"(#include <talus/([a-z_0-9/]+\.hpp)>)");
  Rooms arrows;
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      const std::string from = partOf(file.lexically_relative(TALUS_SOURCE_DIR).generic_string());
      arrows[from];
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i)
        if (const std::string to = partOf((*i)[1]); to != from) arrows[from].insert(to);
    }
  return arrows;
}

TEST(House, NoPartOfARoomIncludesOneAboveIt) {
  // Property: the parts can be put in an order in which each includes only those before it.
  Rooms left = partsIncluded();
  ASSERT_GT(left.size(), 20U);
  std::set<std::string> placed;
  for (bool found = true; found;) {
    found = false;
    for (auto part = left.begin(); part != left.end();) {
      const bool ready =
          std::includes(placed.begin(), placed.end(), part->second.begin(), part->second.end());
      if (ready) placed.insert(part->first);
      part = ready ? left.erase(part) : std::next(part);
      found = found || ready;
    }
  }
  for (const auto& [part, below] : left)
    for (const auto& other : below)
      if (left.contains(other)) ADD_FAILURE() << part << " and " << other << " stand in a circle of includes";
}

TEST(House, TheCheckerOfRoutesSharesNothing) {
  // Property: tests/safety includes no header of ours and links no target of ours.
  for (const auto& file : files("tests/safety", {".hpp", ".cpp", ".txt"})) {
    const std::string source = text(file);
    EXPECT_EQ(source.find("<talus/"), std::string::npos) << file;
    EXPECT_EQ(source.find("talus::"), std::string::npos) << file;
    EXPECT_EQ(source.find("talus_test("), std::string::npos) << file << ": links talus::common";
  }
  EXPECT_GT(files("tests/safety", {".cpp"}).size(), 8U);
}

// What each unit (a header and its source) includes of the rooms.
Rooms unitsIncluded() {
  const std::regex include(R"(#include <talus/([a-z_0-9/]+)\.hpp>)");
  Rooms arrows;
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      const std::string unit = file.lexically_relative(TALUS_SOURCE_DIR).replace_extension().generic_string();
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i)
        if ((*i)[1] != unit) arrows[unit].insert((*i)[1]);
    }
  return arrows;
}

TEST(House, NoTwoUnitsIncludeEachOther) {
  const Rooms arrows = unitsIncluded();
  ASSERT_GT(arrows.size(), 200U);
  for (const auto& [unit, others] : arrows)
    for (const auto& other : others)
      if (unit < other && arrows.contains(other)) {
        EXPECT_FALSE(arrows.at(other).contains(unit)) << unit << " and " << other << " include each other";
      }
}

TEST(House, FoldersHaveAtMostFortyFiles) {
  // Property: a place is found by reading one folder's list.
  std::map<std::string, int> count;
  for (const std::string room : {"common", "terramech", "maps", "costmap", "planner", "cli", "tests"})
    for (const auto& file : files(room, {".hpp", ".cpp"}))
      ++count[file.parent_path().lexically_relative(TALUS_SOURCE_DIR).generic_string()];
  for (const auto& [folder, files_in_it] : count) EXPECT_LE(files_in_it, 40) << folder;
}

TEST(House, FilesHaveOneIdea) {
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      EXPECT_LE(std::count(source.begin(), source.end(), '\n'), 400) << file;
    }
}

// Types and constants of anonymous namespaces, by source: what TALUS_UNITY compiles together may have each but once.
TEST(House, SourcesOfAFolderShareNoNames) {
  const std::regex type(R"(^(?:struct|class|enum class|enum) (\w+)[^;]*$)"),
      constant(R"(^constexpr [^(]*?\b(k[A-Z]\w*)\s*[={\[])");
  std::map<std::string, std::string> first;  // folder and name -> source
  std::size_t names = 0;
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".cpp"})) {
      if (file.parent_path().filename() == "python") continue;  // each compiled alone
      std::istringstream lines(text(file));
      bool inside = false;
      for (std::string line; std::getline(lines, line);) {
        if (line == "namespace {") inside = true;
        if (line == "}  // namespace") inside = false;
        std::smatch found;
        if (!inside || !(std::regex_search(line, found, type) || std::regex_search(line, found, constant)))
          continue;
        ++names;
        const auto [at, is_new] =
            first.emplace(file.parent_path().generic_string() + ' ' + found[1].str(), file.string());
        EXPECT_TRUE(is_new || at->second == file.string())
            << found[1] << " in " << file << " and " << at->second << ": rename one";
      }
    }
  EXPECT_GT(names, 500U);
}

}  // namespace arrows_test
}  // namespace talus::house
