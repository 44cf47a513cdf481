// A module's README is one page with a line for each folder; documents name only commands, headers and
// files that exist.
#include <algorithm>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::architecture {
namespace readme_test {

namespace fs = std::filesystem;

const char* const kModules[] = {"terramech", "maps", "costmap", "planner", "cli"};

TEST(Readme, IsOnePageWithALineForEachFolderOfTheModule) {
  int folders = 0;
  for (const std::string module : kModules) {
    const std::string page = text(fs::path(TALUS_SOURCE_DIR) / module / "README.md");
    EXPECT_LE(std::count(page.begin(), page.end(), '\n'), 100) << module << "/README.md";
    for (const auto& entry : fs::directory_iterator(fs::path(TALUS_SOURCE_DIR) / module)) {
      if (!entry.is_directory()) continue;
      ++folders;
      const std::string folder = "`" + entry.path().filename().string() + "/`";
      EXPECT_NE(page.find(folder), std::string::npos) << module << "/README.md has no line for " << folder;
    }
  }
  EXPECT_GT(folders, 20);
}

TEST(Readme, NamesOnlyHeadersThatExist) {
  const std::regex header(R"(([a-z_][a-z_/]*\.hpp))");
  int named = 0;
  for (const std::string module : {"common", "maps", "costmap"}) {
    const std::string page = text(fs::path(TALUS_SOURCE_DIR) / module / "README.md");
    for (std::sregex_iterator i(page.begin(), page.end(), header), end; i != end; ++i, ++named)
      EXPECT_TRUE(fs::exists(fs::path(TALUS_SOURCE_DIR) / module / (*i)[1].str()) ||
                  fs::exists(fs::path(TALUS_SOURCE_DIR) / (*i)[1].str()))
          << module << "/README.md: " << (*i)[1];
  }
  EXPECT_GT(named, 30);
}

/// Matches of the first group of a pattern in all documents.
std::set<std::string> named(const std::regex& pattern) {
  std::set<std::string> words;
  for (const auto& file : documents()) {
    const std::string page = text(file);
    for (std::sregex_iterator i(page.begin(), page.end(), pattern), end; i != end; ++i) words.insert((*i)[1]);
  }
  return words;
}

TEST(Documents, NameOnlyCallsThatExist) {
  const auto calls = named(std::regex(R"((?:`|\n {4}|\n)talus ([a-z]+)\b)"));
  EXPECT_GT(calls.size(), 10U);
  for (const std::string& call : calls)
    EXPECT_TRUE(fs::exists(fs::path(TALUS_SOURCE_DIR) / "cli/commands" / (call + "_command.cpp"))) << call;
}

TEST(Documents, NameOnlyJobsOfDevThatExist) {
  const std::string dev = text(TALUS_SOURCE_DIR "/dev");
  const auto jobs = named(std::regex(R"(\./dev ([a-z]+(?:-[a-z]+)*)\b)"));
  EXPECT_GT(jobs.size(), 3U);
  for (const std::string& job : jobs) EXPECT_NE(dev.find("\n  " + job + ")"), std::string::npos) << job;
}

TEST(Documents, LinkOnlyToFilesThatExist) {
  const std::regex link(R"(\]\(([^)#:]+)\))");
  for (const auto& file : documents()) {
    const std::string page = text(file);
    for (std::sregex_iterator i(page.begin(), page.end(), link), end; i != end; ++i)
      EXPECT_TRUE(fs::exists(file.parent_path() / (*i)[1].str())) << file << " links to " << (*i)[1];
  }
}

}  // namespace readme_test
}  // namespace talus::architecture
