#include <talus/planner/field/map_change.hpp>

#include "changed_map.hpp"

namespace talus::planner {
namespace map_change_test {

using costmap::CellCode;
using testing::randomMap;

std::shared_ptr<const costmap::CostGrid> with(const costmap::CostGrid& map,
                                              const std::vector<maps::Cell>& cells) {
  costmap::Revision revision{
      .code = [](maps::Cell, CellCode code) { return code.withCurve(CellCode::kBlocked); },
      .cost = [cost = map.content().cost] { return cost; }};
  for (const maps::Cell cell : cells) revision.ranges.push_back({cell, cell});
  return std::make_shared<costmap::CostGrid>(costmap::revised(map, revision));
}

// Property: the result is the smallest box that contains the changed cells, across tiles of 64 cells and at
// the map's border.
TEST(MapChange, ChangeIsTheMinimalBoxOfDifferingCells) {
  const auto map = randomMap({.width = 150, .height = 140, .seed = 4, .blocked = 0.0});
  for (unsigned seed = 1; seed <= 30; ++seed) {
    testing::Below below(seed);
    std::vector<maps::Cell> cells;
    CellBox box{{150, 140}, {-1, -1}};
    for (int k = below(4); k >= 0; --k) {
      cells.push_back({below(150), below(140)});
      box.first = {std::min(box.first.column, cells.back().column),
                   std::min(box.first.row, cells.back().row)};
      box.last = {std::max(box.last.column, cells.back().column), std::max(box.last.row, cells.back().row)};
    }
    const auto found = changedCells(*map, *with(*map, cells));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->first, box.first) << seed;
    EXPECT_EQ(found->last, box.last) << seed;
  }
}

TEST(MapChange, EqualMapsHaveNoChange) {
  const auto map = randomMap({.width = 70, .height = 70, .blocked = 1.0});
  EXPECT_FALSE(changedCells(*map, *map));
  EXPECT_FALSE(changedCells(*map, *with(*map, {{5, 5}, {68, 2}})));  // rewritten with the same values
}

}  // namespace map_change_test
}  // namespace talus::planner
