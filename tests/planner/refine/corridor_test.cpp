#include <cmath>
#include <set>

#include <talus/planner/refine/corridor.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace corridor_test {

using maps::Cell;
using testing::randomMap;

// Property: the corridor contains the cells within reach, in column and row, of a cell on the path, and
// other cells are unknown. The path is sampled densely; its ends lie off edges and corners.
TEST(Corridor, CorridorContainsCellsWithinReachOfTheRoute) {
  const auto map = randomMap({.width = 40, .height = 30, .seed = 2, .blocked = 0.0, .roughness = 0.35});
  const EdgeCrossings crossings(map->cost(), 3);
  const std::vector<maps::Point> way{{2.3, 3.4}, {20.7, 3.9}, {36.2, 27.3}};
  for (const int reach : {0, 1, 4}) {
    const Corridor corridor(*map, crossings, way, reach);
    std::set<std::pair<int, int>> passed;
    for (std::size_t i = 1; i < way.size(); ++i)
      for (double t = 0.0; t <= 1.0; t += 1e-4)
        passed.emplace(static_cast<int>(way[i - 1].x_m + t * (way[i].x_m - way[i - 1].x_m)),
                       static_cast<int>(way[i - 1].y_m + t * (way[i].y_m - way[i - 1].y_m)));
    int open = 0, missed = 0, free = 0;
    for (int row = 0; row < 30; ++row)
      for (int column = 0; column < 40; ++column) {
        bool near = false;
        for (const auto& [x, y] : passed)
          near = near || (std::abs(x - column) <= reach && std::abs(y - row) <= reach);
        // Cells outside the corridor's box may not be read.
        if (row < 3 - reach - 2 || row > 27 + reach + 2 || column < 2 - reach - 2 || column > 36 + reach + 2)
          continue;
        const std::size_t at = corridor.local({column, row});
        const bool held = corridor.code(at).curve() != costmap::CellCode::kUnknown;
        if (held) {
          EXPECT_TRUE(near) << reach << ": " << column << "," << row;
          EXPECT_EQ(corridor.code(at), map->at({column, row}));
          EXPECT_EQ(corridor.free(at), crossings.free(map->at({column, row})));
          ++open;
          free += corridor.free(at);
        }
        missed += near && !held;
      }
    EXPECT_GT(open, 40);
    EXPECT_GT(free, 10);
    EXPECT_GT(open - free, 10);
    // Steps of less than a cell miss a cell whose corner the path cuts; its neighbours are included.
    EXPECT_LE(missed, reach == 0 ? static_cast<int>(passed.size()) / 2 : open / 10) << reach;
  }
}

// Property: numbers and coordinates of cells are inverse to each other, and beyond a side lies the
// neighbour. Every cell of the corridor and its neighbours in the east and north have their own edge
// numbers.
TEST(Corridor, CellAndEdgeNumbersAreConsistent) {
  const auto map = randomMap({.width = 20, .height = 20, .seed = 3, .blocked = 0.0});
  const EdgeCrossings crossings(map->cost(), 2);
  const Corridor corridor(*map, crossings, {{3.5, 4.5}, {15.5, 12.5}}, 2);
  std::set<std::uint32_t> holders;
  for (int row = 3; row < 14; ++row)
    for (int column = 2; column < 17; ++column) {
      const std::size_t at = corridor.local({column, row});
      EXPECT_EQ(corridor.cell(at), (Cell{column, row}));
      EXPECT_EQ(corridor.cell(corridor.beyond(at, kWestSide)), (Cell{column - 1, row}));
      EXPECT_EQ(corridor.cell(corridor.beyond(at, kEastSide)), (Cell{column + 1, row}));
      EXPECT_EQ(corridor.cell(corridor.beyond(at, kSouthSide)), (Cell{column, row - 1}));
      EXPECT_EQ(corridor.cell(corridor.beyond(at, kNorthSide)), (Cell{column, row + 1}));
      if (corridor.code(at).curve() == costmap::CellCode::kUnknown) continue;
      for (const std::size_t each : {at, corridor.beyond(at, kEastSide), corridor.beyond(at, kNorthSide)}) {
        const std::uint32_t holder = corridor.holder(each);
        ASSERT_LT(holder, corridor.holders());
        EXPECT_EQ(corridor.held(holder), each);
        holders.insert(holder);
      }
    }
  EXPECT_GT(holders.size(), 50U);
}

}  // namespace corridor_test
}  // namespace talus::planner
