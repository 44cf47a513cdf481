#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {
namespace cost_grid_test {

CostGrid plain(int side) {
  const maps::Grid grid{.width = side, .height = side, .resolution_m = 1.0, .south_west = {}};
  return flattened(maps::Raster<CellCode>(grid, CellCode({.curve = 0})),
                   std::make_shared<TravelCost>(TravelCost::Limits{}, std::vector<TravelCurve>(1)));
}

TEST(CostGrid, RevisionChangesOnlyItsRange) {
  const CostGrid before = plain(200);
  const maps::CellBox range{{60, 60}, {70, 66}};
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

TEST(CostGrid, ElevationMatchesTheSourceRaster) {
  maps::Raster<float> heights(plain(150).grid());
  for (int row = 0; row < 150; ++row)
    for (int column = 0; column < 150; ++column)
      heights[{column, row}] = static_cast<float>((7 * column + 3 * row) % 11);
  CostGrid::Content content = plain(150).content();
  EXPECT_FALSE(CostGrid(content).elevation_m({1.0, 1.0})) << "not known";
  content.elevation_m = tiled(heights);
  const CostGrid grid(content);
  for (const maps::Point p :
       {maps::Point{0.1, 0.1}, {63.9, 64.2}, {64.0, 127.7}, {149.9, 149.9}, {31.4, 15.9}})
    EXPECT_EQ(grid.elevation_m(p), maps::elevationAt(heights, p)) << p.x_m << ' ' << p.y_m;
  EXPECT_FALSE(grid.elevation_m({150.5, 1.0}));
  content.elevation_m = HeightTable(1, grid.content().elevation_m[0]);
  EXPECT_THROW(CostGrid{content}, std::invalid_argument);
}

// Property: after any sequence of shared tiles is set in several tables, each table equals a plain list.
TEST(TileTable, CopiesAreIndependent) {
  const auto tileOf = [](std::uint8_t curve) {
    auto tile = std::make_shared<CostTile>();
    tile->cells.fill(CellCode({.curve = curve}));
    return TileTable::Shared(std::move(tile));
  };
  std::vector<std::vector<TileTable::Shared>> plain{std::vector<TileTable::Shared>(150, tileOf(0))};
  std::vector<TileTable> tables{TileTable(plain[0])};
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const std::size_t from = random() % tables.size(), at = random() % 150;
    TileTable next = tables[from];
    std::vector<TileTable::Shared> same = plain[from];
    same[at] = tileOf(static_cast<std::uint8_t>(i + 1));
    next.set(at, same[at]);
    tables.push_back(std::move(next));
    plain.push_back(std::move(same));
  }
  for (std::size_t t = 0; t < tables.size(); ++t) {
    ASSERT_EQ(tables[t].size(), 150U);
    for (std::size_t i = 0; i < 150; ++i) {
      ASSERT_EQ(tables[t][i], plain[t][i]);
      ASSERT_EQ(&tables[t].tile(i), plain[t][i].get());
    }
  }
}

}  // namespace cost_grid_test
}  // namespace talus::costmap
