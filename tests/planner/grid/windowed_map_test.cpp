#include <cmath>

#include <refused.hpp>

#include "rolling_ground.hpp"

namespace talus::planner {
namespace windowed_map_test {

using namespace testing;

TEST(WindowedMap, TilesBesideALineEqualTheFullMap) {
  // Property: the cell codes equal those of the whole map, and cells outside the windows are unknown.
  int asked = 0;
  WindowedMap map = windows(asked);
  const std::vector<maps::Point> line{{250.0, 100.0}, {900.0, 400.0}};
  const auto near = map.around(line, 64.0);
  const auto whole = built(kWhole).published();
  std::size_t same = 0, unknown = 0;
  for (int row = 0; row < kWhole.height; ++row)
    for (int column = 0; column < kWhole.width; ++column) {
      const costmap::CellCode code = near->at({column, row});
      if (code.curve() == costmap::CellCode::kUnknown)
        ++unknown;
      else if (code == whole->at({column, row}))
        ++same;
      else
        FAIL() << "another code at " << column << ", " << row;
    }
  EXPECT_GT(same, 60'000U);
  EXPECT_GT(unknown, 100'000U);
  EXPECT_LE(map.cellsBuilt(), 300'000U);
  ASSERT_TRUE(map.elevation_m({500.0, 215.0}));
  EXPECT_NEAR(*map.elevation_m({500.0, 215.0}), height({500.0, 215.0}), 0.02);  // bilinear between 2 m cells
  EXPECT_FALSE(map.elevation_m({1400.0, -40.0}));
  const int before = asked;
  map.around(line, 64.0);
  EXPECT_EQ(asked, before);  // cached windows are not built again
}

TEST(WindowedMap, InvalidOptionsAreRejected) {
  EXPECT_REFUSED(WindowedMap({.grid = kWhole}), std::invalid_argument, "no overview");
  int asked = 0;
  WindowedMap map = windows(asked);
  WindowedMap shifted({.grid = kWhole, .overview = map.overview(), .build = [](const MapBox& box) {
                         maps::Grid grid = gridOf(box);
                         grid.south_west.x_m += 1.0;
                         return std::optional(built(grid));
                       }});
  EXPECT_REFUSED(shifted.around({{250.0, 100.0}}, 10.0), std::invalid_argument,
                 "what was built is not the cells of the box");
}

}  // namespace windowed_map_test
}  // namespace talus::planner
