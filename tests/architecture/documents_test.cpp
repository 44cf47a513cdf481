// A document has one sentence a line, so that a change of a sentence is a change of a line; lines and table
// cells are short.
#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "source_files.hpp"

namespace talus::architecture {
namespace documents_test {

namespace fs = std::filesystem;

constexpr std::size_t kLongestLine = 300, kLongestCell = 240;

struct Line {
  int number;
  std::string words;
  bool in_table;
};

// Lines of prose and of tables; no code blocks.
std::vector<Line> proseOf(const std::string& page) {
  std::vector<Line> prose;
  std::istringstream lines(page);
  bool code = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto first = line.find_first_not_of(' ');
    const bool fence = first != std::string::npos && line.compare(first, 3, "```") == 0;
    if (fence) code = !code;
    if (!code && !fence && !line.starts_with("    ")) prose.push_back({number, line, line.starts_with("|")});
  }
  return prose;
}

// Returns true if a second sentence begins within the line. Full stops in code spans, link targets and
// abbreviations do not count.
bool holdsTwoSentences(std::string line) {
  line = std::regex_replace(line, std::regex("`[^`]*`"), "C");
  line = std::regex_replace(line, std::regex(R"(\]\([^)]*\))"), "]");
  line = std::regex_replace(line, std::regex(R"(\b(Eqs?|Figs?|al|etc|cf|No|vs|App|e\.g|i\.e|D)\.)"), "A");
  line = std::regex_replace(line, std::regex(R"(^ *(-|\*|\d+\.) +)"), "");
  return std::regex_search(line, std::regex(R"([.!?][")*_\]]* +["(*_\[]*[A-Z0-9])"));
}

std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> cells{""};
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] == '|' && (i == 0 || row[i - 1] != '\\'))
      cells.emplace_back();
    else
      cells.back() += row[i];
  return cells;
}

TEST(DocumentShape, FindsWhatItLooksFor) {
  EXPECT_TRUE(holdsTwoSentences("The rover stops. It then reverses."));
  EXPECT_TRUE(holdsTwoSentences("It stops (at once). `plan` exits."));
  EXPECT_FALSE(holdsTwoSentences("1. Thesis Eq. 3.12, as Ding et al. 2011 use it (`a. B`), is corrected."));
  EXPECT_EQ(cellsOf("| a | b\\|c |").size(), 4U);
  EXPECT_EQ(proseOf("a\n```\nb\n```\n    c\n|d|\n").size(), 2U);
}

TEST(DocumentShape, LinesHoldOneShortSentence) {
  std::size_t lines = 0;
  for (const fs::path& file : documents())
    for (const Line& line : proseOf(text(file))) {
      if (line.in_table) continue;
      ++lines;
      EXPECT_LE(line.words.size(), kLongestLine) << file << ":" << line.number;
      EXPECT_FALSE(holdsTwoSentences(line.words)) << file << ":" << line.number << ": " << line.words;
    }
  EXPECT_GT(lines, 1000U);
}

TEST(DocumentShape, TableCellsAreShort) {
  std::size_t cells = 0;
  for (const fs::path& file : documents())
    for (const Line& line : proseOf(text(file))) {
      if (!line.in_table) continue;
      for (const std::string& cell : cellsOf(line.words)) {
        ++cells;
        EXPECT_LE(cell.size(), kLongestCell) << file << ":" << line.number << ": " << cell;
      }
    }
  EXPECT_GT(cells, 2000U);
}

TEST(DocumentShape, ReadmeFitsOneScreen) {
  const std::string page = text(TALUS_SOURCE_DIR "/README.md");
  EXPECT_LE(std::count(page.begin(), page.end(), '\n'), 60);
  for (const Line& line : proseOf(page))
    if (line.in_table) {
      EXPECT_LE(line.words.size(), 111U) << line.number << ": " << line.words;
    }
}

// The section of the next version: from its heading to the following heading.
std::string nextVersion() {
  const std::string page = text(TALUS_SOURCE_DIR "/CHANGELOG.md");
  const auto from = page.find("\n## "), to = page.find("\n## ", from + 1);
  return page.substr(from, to - from);
}

TEST(DocumentShape, NextVersionHasAtMost25ChangesUnderFourHeadings) {
  std::istringstream lines(nextVersion());
  std::set<std::string> left{"### Added", "### Changed", "### Fixed", "### Removed"};
  int changes = 0;
  for (std::string line; std::getline(lines, line);) {
    changes += line.starts_with("- ") || line.starts_with("* ");
    if (line.starts_with("### ")) {
      EXPECT_EQ(left.erase(line), 1U) << line;
    }
  }
  EXPECT_GT(changes, 0);
  EXPECT_LE(changes, 25);
}

// A module's README is one page with a line for each folder; documents name only commands, headers and
// files that exist.

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

// The page of safety checks names a test for each safety property; every name must be that of an existing test.

std::set<std::string> testNames() {
  const std::regex pattern(R"(TEST(?:_P|_F)?\((\w+), (\w+)\))");
  std::set<std::string> names;
  for (const auto& file : files("tests", {".cpp"})) {
    const std::string source = text(file);
    for (std::sregex_iterator i(source.begin(), source.end(), pattern), end; i != end; ++i)
      names.insert((*i)[1].str() + "." + (*i)[2].str());
  }
  return names;
}

TEST(SafetyPage, EveryTestThatItNamesExists) {
  const std::string page = text(TALUS_SOURCE_DIR "/docs/measurements/safety_checks.md");
  const std::regex pattern(R"(`([A-Z]\w+)\.([A-Z]\w+|\*)`)");
  const auto names = testNames();
  std::size_t named = 0;
  for (std::sregex_iterator i(page.begin(), page.end(), pattern), end; i != end; ++i, ++named) {
    const std::string suite = (*i)[1], test = (*i)[2];
    const auto found = test == "*" ? names.lower_bound(suite + ".") : names.find(suite + "." + test);
    EXPECT_TRUE(found != names.end() && found->starts_with(suite + ".")) << (*i)[0];
  }
  EXPECT_GT(named, 5U);
}

// Every source key cited in a comment or document must exist in REFERENCES.bib.

std::set<std::string> matches(const std::string& where, const std::regex& pattern) {
  std::set<std::string> found;
  for (std::sregex_iterator i(where.begin(), where.end(), pattern), end; i != end; ++i) found.insert((*i)[1]);
  return found;
}

const std::regex& keyPattern() {
  static const std::regex pattern(R"(\b([a-z]+(?:_[a-z]+)*_(?:18|19|20)\d\d[a-z]?)\b)");
  return pattern;
}

TEST(References, EveryCitedKeyIsKnown) {
  const auto known = matches(text(TALUS_SOURCE_DIR "/REFERENCES.bib"), std::regex(R"(@\w+\{([^,\s]+))"));
  ASSERT_GT(known.size(), 5U);
  for (const std::string folder : {"terramech", "maps", "costmap", "planner", "cli", "docs"})
    for (const auto& file : files(folder, {".hpp", ".cpp", ".md", ".yaml"}))
      for (const auto& key : matches(text(file), keyPattern()))
        EXPECT_TRUE(known.contains(key))
            << file << " cites " << key << ", which REFERENCES.bib does not hold";
}

// A comment that cites equation (B..) of docs/belief.md or (T..) of docs/effects.md must cite an existing
// number.

/// Counts how often each equation number ends an indented line of a page.
std::map<int, int> defined(const std::string& page, const std::string& letter) {
  const std::regex pattern("(?:^|\n) {4}[^\n]*\\(" + letter + "(\\d+)\\)(?=\n)");
  const std::string all = text(page);
  std::map<int, int> count;
  for (std::sregex_iterator i(all.begin(), all.end(), pattern), end; i != end; ++i)
    ++count[std::stoi((*i)[1])];
  return count;
}

std::set<int> cited(const std::string& where, const std::string& letter) {
  const std::regex pattern("\\(" + letter + "(\\d+)\\)");
  std::set<int> numbers;
  for (std::sregex_iterator i(where.begin(), where.end(), pattern), end; i != end; ++i)
    numbers.insert(std::stoi((*i)[1]));
  return numbers;
}

TEST(Equations, EveryCitedNumberIsOnThePage) {
  for (const auto& [letter, page] : {std::pair{"B", "belief.md"}, std::pair{"T", "effects.md"}}) {
    const auto known = defined(std::string(TALUS_SOURCE_DIR "/docs/") + page, letter);
    ASSERT_GT(known.size(), 5U) << page;
    for (const std::string folder : {"terramech", "costmap", "cli", "tests", "docs"})
      for (const auto& file : files(folder, {".hpp", ".cpp", ".md"}))
        for (const int number : cited(text(file), letter))
          EXPECT_TRUE(known.contains(number))
              << file << " cites (" << letter << number << "), which docs/" << page << " does not have";
  }
}

TEST(Equations, OfTracingAreNumberedInOrderAndEachIsCitedByCode) {
  const auto known = defined(TALUS_SOURCE_DIR "/docs/effects.md", "T");
  std::set<int> by_code;
  for (const auto& file : files("terramech", {".hpp", ".cpp"})) by_code.merge(cited(text(file), "T"));
  for (int number = 1; number <= static_cast<int>(known.size()); ++number) {
    ASSERT_TRUE(known.contains(number)) << "docs/effects.md lacks (T" << number << ")";
    EXPECT_EQ(known.at(number), 1) << "docs/effects.md has (T" << number << ") twice";
    EXPECT_TRUE(by_code.contains(number)) << "no line of terramech cites (T" << number << ")";
  }
}

// The version is stated in CMakeLists.txt; files of other tools that repeat it agree with it.

// Match of the first group of a pattern in a file; empty without a match.
std::string stated(const std::string& file, const std::string& pattern) {
  const std::string content = text(TALUS_SOURCE_DIR "/" + file);
  std::smatch found;
  return std::regex_search(content, found, std::regex(pattern)) ? found[1].str() : std::string();
}

std::string version() {
  return stated("CMakeLists.txt", R"(project\(talus VERSION (\d+\.\d+\.\d+) )");
}

TEST(VersionTest, FilesAgreeWithCMake) {
  ASSERT_NE(version(), "");
  EXPECT_EQ(stated("debian/changelog", R"(^talus \(([^)]+)\))"), version());
  EXPECT_EQ(stated("CITATION.cff", R"(\nversion: (\S+))"), version());
  EXPECT_EQ(stated("CHANGELOG.md", R"(\n## \[?([0-9.]+))"), version());
  EXPECT_EQ(stated("examples/ros2/package.xml", "<version>([^<]+)<"), version());
}

TEST(VersionTest, PythonPackageReadsItFromCMake) {
  EXPECT_EQ(stated("pyproject.toml", R"(\n(version) *=)"), "");
  EXPECT_EQ(stated("pyproject.toml", R"x(dynamic = \["(version)"\])x"), "version");
  EXPECT_EQ(stated("planner/python/wheel/wheel_backend.py", R"x(\nVERSION = .*"(CMakeLists.txt)")x"),
            "CMakeLists.txt");
}

TEST(VersionTest, ProjectsOutsideTheTreeRequireIt) {
  // Property: the installed package accepts requests of its own major and minor version only.
  const std::regex required(R"(find_package\(talus (\d+\.\d+) )");
  const std::string minor = version().substr(0, version().rfind('.'));
  int seen = 0;
  for (const std::string folder : {"examples", "tests/install"})
    for (const auto& file : files(folder, {".txt"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), required), end; i != end; ++i, ++seen)
        EXPECT_EQ((*i)[1], minor) << file;
    }
  EXPECT_GE(seen, 5);
}

}  // namespace documents_test
}  // namespace talus::architecture
