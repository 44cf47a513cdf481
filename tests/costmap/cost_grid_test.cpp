#include <memory>

#include <costmap/cost_grid.hpp>

namespace talus::costmap {
namespace {

CostGrid plain(int side) {
  const maps::Grid grid{.width = side, .height = side, .resolution_m = 1.0, .south_west = {}};
  return flattened(maps::Raster<CellCode>(grid, CellCode({.curve = 0})),
                   std::make_shared<DriveCost>(DriveCost::Limits{}, std::vector<DriveCurve>(1)));
}

TEST(CostGrid, ARevisionChangesItsRangeAndNothingElse) {
  const CostGrid before = plain(200);
  const CellRange range{{60, 60}, {70, 66}};
  const CostGrid after =
      revised(before, {.ranges = {range},
                       .code = [](maps::Cell, CellCode code) { return code.withCurve(CellCode::kBlocked); },
                       .cost = [&] { return before.content().cost; }});
  EXPECT_EQ(after.version(), before.version() + 1);
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column) {
      const bool inside = column >= 60 && column <= 70 && row >= 60 && row <= 66;
      ASSERT_EQ(after.at({column, row}).curve(), inside ? CellCode::kBlocked : 0) << column << ' ' << row;
      ASSERT_EQ(before.at({column, row}).curve(), 0);
    }
}

TEST(CostGrid, ARevisionSharesTheTilesItDoesNotTouch) {
  const CostGrid before = plain(200);
  const CostGrid after = revised(before, {.ranges = {{{0, 0}, {5, 5}}},
                                          .code = [](maps::Cell, CellCode code) { return code; },
                                          .cost = [&] { return before.content().cost; }});
  int shared = 0;
  for (std::size_t i = 0; i < before.content().tiles.size(); ++i)
    shared += before.content().tiles[i] == after.content().tiles[i] ? 1 : 0;
  EXPECT_EQ(shared, 15);  // Closed form: 4x4 tiles, one touched
}

}  // namespace
}  // namespace talus::costmap
