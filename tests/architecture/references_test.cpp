// Every source key cited in a comment or document must exist in REFERENCES.bib.
#include <algorithm>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::architecture {
namespace references_test {

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

}  // namespace references_test
}  // namespace talus::architecture
