#include <map>
#include <random>
#include <tuple>

#include <talus/costmap/evidence_bricks.hpp>

namespace talus::costmap {
namespace {

using Key = std::tuple<int, int, std::uint16_t>;

// Property: whatever is put in, in any order, a plain std::map of the same says the same.
TEST(EvidenceBricks, AgreeWithAPlainMap) {
  std::mt19937 random(7);
  EvidenceBricks bricks(21, 13);  // no multiple of a brick
  std::map<Key, float> plain;
  for (int i = 0; i < 2000; ++i) {
    const BlockLevel at{static_cast<int>(random() % 21), static_cast<int>(random() % 13),
                        random() % 3 ? BlockEvidence::kTop : static_cast<std::uint16_t>(random() % 4)};
    bricks.at(at).weight += 1.0F;
    plain[{at.column, at.row, at.level}] += 1.0F;
  }
  for (int row = -1; row <= 13; ++row)
    for (int column = -1; column <= 21; ++column) {
      std::size_t known = 0;
      for (const std::uint16_t level : {std::uint16_t{0}, std::uint16_t{3}, BlockEvidence::kTop}) {
        const auto expected = plain.find({column, row, level});
        const BlockEvidence* found = bricks.find({column, row, level});
        ASSERT_EQ(found != nullptr, expected != plain.end()) << column << ' ' << row;
        EXPECT_TRUE(!found || found->weight == expected->second);
      }
      for (const auto& [key, weight] : plain) known += std::get<0>(key) == column && std::get<1>(key) == row;
      const auto levels = bricks.levels(column, row);
      EXPECT_EQ(levels.size(), known);
      for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_LT(levels[i - 1]->level, levels[i]->level);
    }
  // A box that reaches outside on three sides.
  std::size_t inside = 0, visited = 0;
  for (const auto& [key, weight] : plain)
    inside += std::get<0>(key) <= 11 && std::get<1>(key) >= 5 && std::get<2>(key) == BlockEvidence::kTop;
  bricks.visitTop({-4, 5, 11, 40}, [&](const BlockLevel& at, const BlockEvidence& e) {
    ++visited;
    EXPECT_EQ(e.weight, (plain[{at.column, at.row, at.level}]));
  });
  EXPECT_EQ(visited, inside);
  EXPECT_GT(inside, 20U);
}

}  // namespace
}  // namespace talus::costmap
