// The page of safety checks names a test for each safety property; every name must be that of an existing test.
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::architecture {
namespace safety_page_test {

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

}  // namespace safety_page_test
}  // namespace talus::architecture
