#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/raster_frame.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace raster_frame_test {

using testing::Contains;
using testing::HasSubstr;

TEST(RasterFrame, WithoutCrsTheResolutionIsRequired) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .crs = "", .transform = std::array<double, 6>{-20, 0.5, 0, 30, 0, -0.5}},
            folder / "yard.tif");
  const ElevationMap map = readElevation(path, {.resolution_m = 0.5});
  EXPECT_FALSE(map.georeference);
  EXPECT_EQ(map.grid(), (Grid{.width = 4, .height = 5, .resolution_m = 0.5, .south_west = {-20, 27.5}}));
  // A resolution that contradicts the file would change slopes and origin.
  for (const double other_m : {0.1, 1.0})
    EXPECT_THAT(refusal([&] { readElevation(path, {.resolution_m = other_m}); }),
                HasSubstr("states cells of 0.5, --resolution states"));
  const std::string bogus = write({.rows = kHill, .crs = "EPSG:4326"}, folder / "bogus.tif");
  EXPECT_EQ(readElevation(bogus, {.resolution_m = 2.0, .ignore_crs = true}).grid().resolution_m, 2.0);
}

// Property: a cone of 20 degrees on a map in degrees has the same slope after the conversion to metres.
TEST(RasterFrame, GeographicCoordinatesBecomeMetresOnEachBody) {
  const TemporaryFolder folder;
  for (const auto& [crs, radius_m, latitude_deg] :
       {std::tuple{"EPSG:4326", 6371000.0, 62.0}, std::tuple{"IAU_2015:49900", 3396190.0, -4.6},
        std::tuple{"IAU_2015:30100", 1737400.0, -86.0}}) {
    const double step_deg = 30.0 / (radius_m * kDegree);
    const double east_deg = 40;
    RasterFile file{
        .rows = {},
        .crs = crs,
        .transform = std::array<double, 6>{east_deg, 2 * step_deg, 0, latitude_deg, 0, -step_deg}};
    const double south = latitude_deg - 60 * step_deg;
    const double east_m =
        2 * step_deg * kDegree * radius_m * std::cos((latitude_deg - 30 * step_deg) * kDegree);
    for (int r = 0; r < 60; ++r) {
      file.rows.emplace_back();
      for (int c = 0; c < 60; ++c) file.rows.back().push_back(0.3 * (59.5 - r) * 30 + 0.2 * c * east_m);
    }
    const ElevationMap map = readElevation(write(file, folder / "degrees.tif"));
    const Georeference& g = *map.georeference;
    const Point a = g.forward({(south + 20 * step_deg) * kDegree, (east_deg + 40 * step_deg) * kDegree});
    const Point b = g.forward({(south + 40 * step_deg) * kDegree, (east_deg + 80 * step_deg) * kDegree});
    // Closed form: heights at two places of known latitude and longitude.
    EXPECT_NEAR(elevationAt(map.elevation_m, a).value(), 0.3 * 20 * 30 + 0.2 * 19.5 * east_m, 0.5) << crs;
    EXPECT_NEAR(elevationAt(map.elevation_m, b).value(), 0.3 * 40 * 30 + 0.2 * 39.5 * east_m, 0.5) << crs;
    const double ground_m = std::hypot(20 * 30.0, 20 * east_m);
    EXPECT_NEAR(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) / ground_m, 1.0, 5e-3) << crs;
  }
}

// Property: a raster with coordinates outside the body is rejected, not wrapped in longitude.
TEST(RasterFrame, DegreesOutOfRangeAreRejected) {
  const TemporaryFolder folder;
  const auto read = [&folder](double east_deg, double north_deg) {
    const RasterFile file{.rows = std::vector<std::vector<double>>(4, std::vector<double>(4, 1.0)),
                          .crs = "EPSG:4326",
                          .transform = std::array<double, 6>{east_deg, 0.001, 0, north_deg, 0, -0.001}};
    readElevation(write(file, folder / "degrees.tif"));
  };
  EXPECT_NO_THROW(read(359.0, 10.0));
  EXPECT_NO_THROW(read(-180.0005, 10.0));
  for (const auto& [east_deg, north_deg] :
       {std::pair{500.0, 10.0}, {-361.0, 10.0}, {0.0, 200.0}, {0.0, 90.03}, {0.0, -90.5}})
    EXPECT_THAT([&] { read(east_deg, north_deg); },
                testing::ThrowsMessage<InputError>(HasSubstr("must be within 360 and 90 degrees")))
        << east_deg << ", " << north_deg;
}

TEST(RasterFrame, RotatedAndNonSquarePixelsAreResampled) {
  const TemporaryFolder folder;
  std::vector<std::vector<double>> rows(40, std::vector<double>(40));
  const std::array<double, 6> turned{500000, 8, 6, 5000000, 6, -8};
  for (int r = 0; r < 40; ++r)
    for (int c = 0; c < 40; ++c)
      rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = 0.1 * ((c + 0.5) * 8 + (r + 0.5) * 6);
  const ElevationMap map = readElevation(write({.rows = rows, .transform = turned}, folder / "turned.tif"));
  EXPECT_NEAR(map.grid().resolution_m, 10, 1e-9);
  EXPECT_THAT(map.notes, Contains(HasSubstr("resampled to square cells of 10 m")));
  // Closed form: the height is a tenth of the distance east.
  EXPECT_NEAR(elevationAt(map.elevation_m, {500280, 5000000}).value(), 28.0, 0.01);
  EXPECT_NEAR(elevationAt(map.elevation_m, {500300, 4999990}).value(), 30.0, 0.01);
}

TEST(RasterFrame, DistortedProjectionsAreReprojectedToTrueScale) {
  const TemporaryFolder folder;
  // At 60 degrees north this projection doubles distances from west to east.
  const std::string path =
      write({.rows = std::vector<std::vector<double>>(20, std::vector<double>(40, 7.0)),
             .crs = "IAU_2015:49910",
             .transform = std::array<double, 6>{0, 20, 0, 60 * kDegree * 3396190, 0, -20}},
            folder / "north.tif");
  const ElevationMap map = readElevation(path);
  EXPECT_THAT(map.notes, Contains(HasSubstr("resampled to true metres")));
  EXPECT_NEAR(map.grid().width * map.grid().resolution_m, 400, 30);
  EXPECT_NEAR(map.grid().height * map.grid().resolution_m, 400, 30);
}

// Closed form: US survey feet of 1200/3937 m; the first row is the southernmost if y increases with the row.
TEST(RasterFrame, FeetAreConvertedAndSouthUpRowsDetected) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .crs = "EPSG:2227", .transform = std::array<double, 6>{6e6, 10, 0, 2e6, 0, 10}},
            folder / "feet.tif");
  std::vector<std::string> notes;
  const Dataset file = openRaster(path);
  const FramedRaster framed = frame(*file, {}, path, notes);
  const double foot_m = 1200.0 / 3937.0;
  EXPECT_FALSE(framed.north_up);
  EXPECT_NEAR(framed.grid.resolution_m, 10 * foot_m, 1e-9);
  EXPECT_NEAR(framed.grid.south_west.x_m, 6e6 * foot_m, 1e-3);
  EXPECT_NEAR(framed.grid.south_west.y_m, 2e6 * foot_m, 1e-3);
  EXPECT_TRUE(notes.empty());
}

}  // namespace raster_frame_test

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
