#include "public_headers.hpp"

#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "source_files.hpp"

namespace talus::architecture {
namespace public_headers_test {

TEST(PublicHeaders, AreThoseThatCMakeInstalls) {
  const auto headers = test::publicHeaders(TALUS_SOURCE_DIR);
  EXPECT_GT(headers.size(), 20U);
  EXPECT_LE(headers.size(), 31U);
  for (const auto& header : headers)
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(TALUS_SOURCE_DIR) / header)) << header;
}

TEST(PublicHeaders, StateUnitsWhereTheyHaveNumbers) {
  // Property: the name of a number ends with its unit, or a comment states the unit or "[-]" for no unit.
  const std::regex number(R"(\b(double|float) )"),
      unit(
          R"(_(m|m2|m_s2|rad|deg|Pa|kPa|N|Nm|J|W|s|mps|kg|mm|Jpm|J_per_m|per_m|cells)\b)"
          R"(|\[-\]|\[1?/?(m|rad|s|N|Pa|J|W|kg)\b|over (the )?(load|wheel radius|radius)|[Pp]robability|0 to 1)");
  int with_numbers = 0, with_units = 0;
  for (const auto& header : test::publicHeaders(TALUS_SOURCE_DIR)) {
    const std::string source = text(std::filesystem::path(TALUS_SOURCE_DIR) / header);
    if (!std::regex_search(source, number)) continue;
    ++with_numbers;
    with_units += std::regex_search(source, unit);
  }
  EXPECT_GT(with_numbers, 20);
  EXPECT_GE(with_units, 0.8 * with_numbers);
}

// Examples and installed consumers include umbrella headers only, as a program that embeds Talus does.

TEST(Architecture, ExamplesAndConsumersIncludeEntryHeadersOnly) {
  const std::set<std::string> entries{"talus.hpp",
                                      "terramech/terramech.hpp",
                                      "terramech/terramech_io.hpp",
                                      "terramech/calibration.hpp",
                                      "maps/maps.hpp",
                                      "maps/maps_io.hpp",
                                      "costmap/costmap.hpp",
                                      "planner/planner.hpp",
                                      "planner/plugin/plugin_export.hpp",  // for plugins
                                      "planner/simulation/simulation.hpp"};
  const std::regex include(R"(#include <talus/([a-z_0-9/]+\.hpp)>)");
  int seen = 0;
  for (const std::string folder : {"examples", "tests/install"})
    for (const auto& file : files(folder, {".cpp"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i, ++seen)
        EXPECT_TRUE(entries.contains((*i)[1])) << file << " includes <talus/" << (*i)[1] << ">";
    }
  EXPECT_GE(seen, 6);
}

// Headers have an order in which each includes only headers before it.
TEST(Architecture, HeadersIncludeWithoutCycles) {
  const std::regex include(R"(#include <talus/([a-z_0-9/]+\.hpp)>)");
  std::map<std::string, std::set<std::string>> left;
  for (const std::string module : {"common", "terramech", "maps", "costmap", "planner", "cli"})
    for (const auto& file : files(module, {".hpp"})) {
      const std::string source = text(file);
      auto& below = left[file.lexically_relative(TALUS_SOURCE_DIR).generic_string()];
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i)
        below.insert((*i)[1]);
    }
  ASSERT_GT(left.size(), 100U);
  for (bool found = true; found;) {
    found = std::erase_if(left, [](const auto& header) { return header.second.empty(); }) > 0;
    for (auto& [header, below] : left)
      std::erase_if(below, [&](const std::string& other) { return !left.contains(other); });
  }
  for (const auto& [header, below] : left) ADD_FAILURE() << header << " is in a cycle of includes";
}

}  // namespace public_headers_test
}  // namespace talus::architecture
