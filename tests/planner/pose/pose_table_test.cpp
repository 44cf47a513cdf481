#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/pose/pose_table.hpp>

namespace talus::planner {
namespace pose_table_test {

// Property: the table equals a map from cell and heading whose missing entries are infinite.
TEST(PoseTable, TableMatchesAMapKeyedByCellAndHeading) {
  constexpr std::size_t kCells = 300, kHeadings = 7;
  PoseTable table(kCells, kHeadings);
  std::map<std::pair<std::size_t, std::size_t>, float> expected;
  std::mt19937 random(6);
  int known = 0, unknown = 0;
  for (int k = 0; k < 5'000; ++k) {
    const std::pair key{random() % kCells, random() % kHeadings};
    const auto found = expected.find(key);
    const float value = table.at(key.first, key.second);
    ++(found == expected.end() ? unknown : known);
    if (found == expected.end())
      ASSERT_TRUE(std::isinf(value));
    else
      ASSERT_EQ(value, found->second);
    if (k % 3 == 0) table.at(key.first, key.second) = expected[key] = static_cast<float>(k);
  }
  EXPECT_GT(known, 1'000);
  EXPECT_GT(unknown, 1'000);
}

}  // namespace pose_table_test
}  // namespace talus::planner
