// Modules, their folders and their units include each other in one direction only.
#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::architecture {
namespace dependencies_test {

using Graph = std::map<std::string, std::set<std::string>>;

const Graph& modulesBelow() {
  static const Graph below{{"common", {}},
                           {"terramech", {"common"}},
                           {"maps", {"common"}},
                           {"costmap", {"common", "terramech", "maps"}},
                           {"planner", {"common", "terramech", "maps", "costmap"}},
                           {"cli", {"common", "terramech", "maps", "costmap", "planner"}}};
  return below;
}

TEST(Architecture, ModulesIncludeOnlyModulesBelow) {
  const std::regex include(R"(#include <talus/(common|terramech|maps|costmap|planner|cli)/)");
  for (const auto& [module, below] : modulesBelow())
    for (const auto& file : files(module, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i) {
        const std::string other = (*i)[1];
        EXPECT_TRUE(other == module || below.contains(other)) << file << " includes <" << other << "/...>";
      }
    }
}

// The folder of a path below the source folder or of an include: "module", "module/folder" or deeper.
std::string folderOf(const std::string& path) {
  return path.substr(0, path.rfind('/'));
}

Graph foldersIncluded() {
  const std::regex include(R"(#include <talus/([a-z_0-9/]+\.hpp)>)");
  Graph edges;
  for (const auto& [module, below] : modulesBelow())
    for (const auto& file : files(module, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      const std::string from = folderOf(file.lexically_relative(TALUS_SOURCE_DIR).generic_string());
      edges[from];
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i)
        if (const std::string to = folderOf((*i)[1]); to != from) edges[from].insert(to);
    }
  return edges;
}

TEST(Architecture, FoldersIncludeWithoutCycles) {
  // Property: the folders have an order in which each includes only folders before it.
  Graph left = foldersIncluded();
  ASSERT_GT(left.size(), 20U);
  std::set<std::string> placed;
  for (bool found = true; found;) {
    found = false;
    for (auto folder = left.begin(); folder != left.end();) {
      const bool ready =
          std::includes(placed.begin(), placed.end(), folder->second.begin(), folder->second.end());
      if (ready) placed.insert(folder->first);
      folder = ready ? left.erase(folder) : std::next(folder);
      found = found || ready;
    }
  }
  for (const auto& [folder, below] : left)
    for (const auto& other : below)
      if (left.contains(other))
        ADD_FAILURE() << folder << " and " << other << " include each other in a cycle";
}

TEST(Architecture, RouteCheckerSharesNoCode) {
  // Property: tests/safety includes no header of Talus and links no target of Talus.
  for (const auto& file : files("tests/safety", {".hpp", ".cpp", ".txt"})) {
    const std::string source = text(file);
    EXPECT_EQ(source.find("<talus/"), std::string::npos) << file;
    EXPECT_EQ(source.find("talus::"), std::string::npos) << file;
    EXPECT_EQ(source.find("talus_test("), std::string::npos) << file << ": links talus::common";
  }
  EXPECT_GT(files("tests/safety", {".cpp"}).size(), 8U);
}

// The headers of Talus that each unit (a header and its source) includes.
Graph unitsIncluded() {
  const std::regex include(R"(#include <talus/([a-z_0-9/]+)\.hpp>)");
  Graph edges;
  for (const auto& [module, below] : modulesBelow())
    for (const auto& file : files(module, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      const std::string unit = file.lexically_relative(TALUS_SOURCE_DIR).replace_extension().generic_string();
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i)
        if ((*i)[1] != unit) edges[unit].insert((*i)[1]);
    }
  return edges;
}

TEST(Architecture, UnitsDoNotIncludeEachOther) {
  const Graph edges = unitsIncluded();
  ASSERT_GT(edges.size(), 200U);
  for (const auto& [unit, others] : edges)
    for (const auto& other : others)
      if (unit < other && edges.contains(other)) {
        EXPECT_FALSE(edges.at(other).contains(unit)) << unit << " and " << other << " include each other";
      }
}

// TALUS_UNITY compiles the sources of a folder together: types and constants of anonymous namespaces need
// distinct names.
TEST(Architecture, SourcesOfAFolderHaveDistinctNames) {
  const std::regex type(R"(^(?:struct|class|enum class|enum) (\w+)[^;]*$)"),
      constant(R"(^constexpr [^(]*?\b(k[A-Z]\w*)\s*[={\[])");
  std::map<std::string, std::string> first;  // folder and name -> source
  std::size_t names = 0;
  for (const auto& [module, below] : modulesBelow())
    for (const auto& file : files(module, {".cpp"})) {
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

}  // namespace dependencies_test
}  // namespace talus::architecture
