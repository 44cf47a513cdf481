#include <cmath>

#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/raster_frame.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace warp_test {

using testing::HasSubstr;

std::vector<float> pixels(GDALDataset& raster) {
  return Quantity().of({raster, 1, wholeOf(raster), "test"});
}

// The plane 100 + 2 column + 3 row, rows from the north, pixels of 10 m.
std::string plane(const TemporaryFolder& folder) {
  std::vector<std::vector<double>> rows(20, std::vector<double>(30));
  for (std::size_t r = 0; r < 20; ++r)
    for (std::size_t c = 0; c < 30; ++c)
      rows[r][c] = 100.0 + 2.0 * static_cast<double>(c) + 3.0 * static_cast<double>(r);
  return write({.rows = rows}, folder / "plane.tif");
}

TEST(Warp, IdenticalGridKeepsValues) {
  const TemporaryFolder folder;
  const Dataset source = openRaster(write({.rows = kHill, .nodata = -1}, folder / "hill.tif"));
  const Grid grid{.width = 4, .height = 5, .resolution_m = 10, .south_west = {500000, 4999950}};
  const std::vector<float> values = pixels(*warp(*source, {.grid = grid, .method = "near"}, "test"));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = kHill[i / 4][i % 4];
    if (expected < 0)
      EXPECT_TRUE(std::isnan(values[i]));
    else
      EXPECT_EQ(values[i], static_cast<float>(expected));
  }
}

TEST(Warp, InterpolationReproducesAPlane) {
  const TemporaryFolder folder;
  const Dataset source = openRaster(plane(folder));
  const Grid grid{.width = 8, .height = 6, .resolution_m = 5, .south_west = {500101, 4999903}};
  for (const char* method : {"bilinear", "cubic"}) {
    const std::vector<float> values = pixels(*warp(*source, {.grid = grid, .method = method}, "test"));
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 8; ++column) {
        const Point p = grid.centre({column, 5 - row});
        // Closed form: linear interpolation between pixel middles reproduces a plane.
        const double expected = 100 + 2 * ((p.x_m - 500000) / 10 - 0.5) + 3 * ((5000000 - p.y_m) / 10 - 0.5);
        EXPECT_NEAR(values[static_cast<std::size_t>(row * 8 + column)], expected, 1e-3) << method;
      }
  }
}

TEST(Warp, AverageResamplingIsTheMeanOfPixels) {
  const TemporaryFolder folder;
  const Dataset source = openRaster(plane(folder));
  const Dataset coarse = warp(*source, {.resolution = 20, .method = "average"}, "test");
  ASSERT_EQ(coarse->GetRasterXSize(), 15);
  // Closed form: the mean over two by two pixels of the plane.
  EXPECT_NEAR(pixels(*coarse).front(), 100 + 2 * 0.5 + 3 * 0.5, 1e-3);
}

TEST(Warp, InvalidCrsIsRejected) {
  const TemporaryFolder folder;
  const Dataset source = openRaster(plane(folder));
  EXPECT_THAT(refusal([&] { warp(*source, {.wkt = "no CRS at all"}, "a.tif"); }),
              HasSubstr("a.tif: cannot be resampled"));
}

}  // namespace warp_test
}  // namespace talus::maps
