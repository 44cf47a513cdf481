// A comment that cites equation (B..) of docs/belief.md or (T..) of docs/effects.md must cite an existing
// number.
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "source_files.hpp"

namespace talus::architecture {
namespace equations_test {

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

}  // namespace equations_test
}  // namespace talus::architecture
