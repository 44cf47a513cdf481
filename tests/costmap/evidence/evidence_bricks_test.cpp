#include <map>
#include <random>
#include <tuple>

#include <talus/costmap/evidence/evidence_bricks.hpp>

namespace talus::costmap {
namespace evidence_bricks_test {

using Key = std::tuple<int, int, std::uint8_t>;
using Readings = std::map<std::tuple<std::uint8_t, std::uint8_t>, unsigned>;

Readings tableOf(const std::vector<ReadingCount>& counts) {
  Readings out;
  for (const ReadingCount& c : counts) out[{c.kind, c.step}] = c.count;
  EXPECT_EQ(out.size(), counts.size()) << "each value once";
  return out;
}

// Property: after any sequence of insertions, in any order, the content equals that of a std::map with the
// same insertions.
TEST(EvidenceBricks, MatchesAPlainMap) {
  std::mt19937 random(7);
  EvidenceBricks bricks(21, 13);  // not a multiple of the side of a brick
  std::map<Key, Readings> plain;
  for (int i = 0; i < 4000; ++i) {
    const BlockOfClass at{static_cast<int>(random() % 21), static_cast<int>(random() % 13),
                          static_cast<std::uint8_t>(random() % 2)};
    const ReadingCount reading{static_cast<std::uint8_t>(random() % 3),
                               static_cast<std::uint8_t>(random() % 5),
                               static_cast<std::uint16_t>(1 + random() % 2)};
    bricks.at(at);
    bricks.count(at, reading);
    plain[{at.column, at.row, at.terrain_class}][{reading.kind, reading.step}] += reading.count;
  }
  std::size_t all = 0;
  for (int row = -1; row <= 13; ++row)
    for (int column = -1; column <= 21; ++column) {
      for (const std::uint8_t number : {std::uint8_t{0}, std::uint8_t{1}}) {
        const auto expected = plain.find({column, row, number});
        ASSERT_EQ(bricks.find({column, row, number}) != nullptr, expected != plain.end());
        EXPECT_EQ(tableOf(bricks.counts({column, row, number})),
                  expected == plain.end() ? Readings{} : expected->second);
      }
    }
  bricks.visitAll([&](const BlockOfClass&, const BlockEvidence&) { ++all; });
  EXPECT_EQ(all, plain.size());
  // The box extends beyond the map on three sides.
  std::size_t inside = 0, visited = 0;
  for (const auto& [key, heard] : plain) inside += std::get<0>(key) <= 11 && std::get<1>(key) >= 5;
  bricks.visit({-4, 5, 11, 40}, [&](const BlockOfClass& at, const BlockEvidence&) {
    ++visited;
    EXPECT_TRUE(plain.contains({at.column, at.row, at.terrain_class}));
  });
  EXPECT_EQ(visited, inside);
  EXPECT_GT(inside, 20U);
}

// Property: a counter at its maximum stays at its maximum.
TEST(EvidenceBricks, CountsSaturate) {
  EvidenceBricks bricks(8, 8);
  bricks.at({1, 1});
  for (int i = 0; i < 3; ++i) bricks.count({1, 1}, {0, 7, 30000});
  ASSERT_EQ(bricks.counts({1, 1}).size(), 1U);
  EXPECT_EQ(bricks.counts({1, 1})[0].count, 65535);
}

}  // namespace evidence_bricks_test
}  // namespace talus::costmap
