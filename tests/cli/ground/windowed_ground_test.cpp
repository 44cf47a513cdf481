#include <cmath>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/windowed_ground.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace windowed_ground_test {

double rolling(int column, int row) {
  return 2.0 * std::sin(column / 9.0) * std::cos(row / 7.0);
}

GroundOptions options(const Folder& folder) {
  GroundOptions made;
  made.elevation.path = folder.write("dem.asc", asciiGrid(200, 150, rolling));
  made.elevation.read.resolution_m = 1.0;
  made.soil = "sandy_loam";
  made.rover = "fido";
  return made;
}

TEST(WindowedGround, WindowsAreUsedOnlyAboveTheCellLimit) {
  const Folder folder;
  const GroundOptions large = options(folder);
  EXPECT_TRUE(needsWindows(large, 29'999));
  EXPECT_FALSE(needsWindows(large, 30'000));
  GroundOptions built = large;
  built.map_file = "map.ot";
  EXPECT_FALSE(needsWindows(built, 10));
}

// Property: cell codes read by windows equal those of the full ground except near the edge of the DEM; the
// cells of the overview are larger by an integer factor and cover the map.
TEST(WindowedGround, WindowsAreBitIdenticalToTheFullGround) {
  const Folder folder;
  const GroundOptions of = options(folder);
  Context context;
  context.quiet = true;
  const Ground overview = readOverview(of, context), whole = readGround(of, context);
  EXPECT_GE(overview.map.grid().resolution_m, 2.0);
  EXPECT_GE(overview.map.grid().width * overview.map.grid().resolution_m, 200.0);
  EXPECT_GE(overview.map.grid().height * overview.map.grid().resolution_m, 150.0);
  planner::WindowedMap windows = windowsOn(of, overview, context);
  EXPECT_EQ(windows.grid().width, 200);
  const auto near = windows.around({{30.0, 30.0}, {80.0, 60.0}}, 8.0);
  const auto expected = whole.map.published();
  int same = 0;
  for (int row = 0; row < 150; ++row)
    for (int column = 0; column < 200; ++column) {
      const auto code = near->at({column, row});
      if (code.curve() == costmap::CellCode::kUnknown) continue;
      ASSERT_EQ(code, expected->at({column, row})) << column << "," << row;
      ++same;
    }
  EXPECT_GT(same, 3'000);
}

}  // namespace windowed_ground_test
}  // namespace talus::cli
