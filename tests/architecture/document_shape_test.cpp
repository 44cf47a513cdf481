// A document has one sentence a line, so that a change of a sentence is a change of a line; lines and table
// cells are short.
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::architecture {
namespace document_shape_test {

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

}  // namespace document_shape_test
}  // namespace talus::architecture
