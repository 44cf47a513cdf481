#include <cmath>

#include <talus/planner/field/pooled_grid.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pooled_grid_test {

using testing::drawn;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

MapPointer rough(unsigned seed) {
  return randomMap({.width = 320, .height = 300, .seed = seed, .blocked = 0.05, .roughness = 0.12});
}

TEST(PooledGrid, PoolingKeepsMeanGradientAndCost) {
  std::vector<std::string> rows(16, std::string(16, '^'));
  const auto map = drawn(rows);
  const auto coarse = pooled(*map, 8);
  EXPECT_EQ(coarse->grid().width, 2);
  EXPECT_EQ(coarse->grid().resolution_m, 8.0);
  const costmap::Direction north{0.0, 1.0};
  EXPECT_EQ(coarse->at({1, 1}).dzDy(), map->at({0, 0}).dzDy());
  EXPECT_EQ(coarse->cost().costPerMetre(coarse->at({0, 1}), north),
            map->cost().costPerMetre(map->at({0, 0}), north));
}

// Closed form: half of the cells cost 10 and half 50 J/m on level ground, 30 on average, which the levels of
// surcharge round by an eighth at most. A pooled cell is blocked if most of its cells are; with a third
// blocked it costs half as much again.
TEST(PooledGrid, MixedAndBlockedCellsHaveASurcharge) {
  std::vector<std::string> rows;
  for (int row = 0; row < 8; ++row) rows.push_back("..44..44########.....###");
  const auto coarse = pooled(*drawn(rows), 8);
  const costmap::Direction east{1.0, 0.0};
  EXPECT_NEAR(static_cast<double>(coarse->cost().costPerMetre(coarse->at({0, 0}), east)), 30.0, 30.0 / 8);
  EXPECT_TRUE(std::isinf(coarse->cost().costPerMetre(coarse->at({1, 0}), east)));
  EXPECT_NEAR(static_cast<double>(coarse->cost().costPerMetre(coarse->at({2, 0}), east)), 10.0 * 8 / 5,
              16.0 / 8);
}

TEST(PooledGrid, PartialRepoolingEqualsFullPooling) {
  const MapPointer map = rough(5);
  const CellBox box{{37, 80}, {90, 131}};
  const costmap::Revision revision{
      .ranges = {{box.first, box.last}},
      .code = [](maps::Cell cell,
                 costmap::CellCode code) { return code.withCurve(cell.row % 3 == 0 ? 255 : 2); },
      .cost = [&] { return map->content().cost; }};
  const costmap::CostGrid newer = costmap::revised(*map, revision);
  const auto part = repooled(*pooled(*map, 8), newer, 8, box), anew = pooled(newer, 8, 2);
  const auto before = pooled(*map, 8);
  bool differs = false;
  for (int row = 0; row < anew->grid().height; ++row)
    for (int column = 0; column < anew->grid().width; ++column) {
      ASSERT_EQ(part->at({column, row}), anew->at({column, row}));
      differs = differs || !(before->at({column, row}) == anew->at({column, row}));
    }
  EXPECT_TRUE(differs);
}

}  // namespace pooled_grid_test
}  // namespace talus::planner
