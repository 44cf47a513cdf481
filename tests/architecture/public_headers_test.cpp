#include "public_headers.hpp"

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

}  // namespace public_headers_test
}  // namespace talus::architecture
