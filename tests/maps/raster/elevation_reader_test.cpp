#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/raster_frame.hpp>

#include "raster_fixture.hpp"
#include "requirement.hpp"

namespace talus::maps {
namespace elevation_reader_test {

using testing::Contains;
using testing::HasSubstr;

TEST(ElevationReader, RowsAreReadSouthFirstAndNodataAsNan) {
  const TemporaryFolder folder;
  const ElevationMap map = readElevation(write({.rows = kHill, .nodata = -1}, folder / "hill.tif"));
  EXPECT_EQ(map.grid(), (Grid{.width = 4, .height = 5, .resolution_m = 10, .south_west = {500000, 4999950}}));
  EXPECT_EQ((map.elevation_m[{0, 0}]), 5);
  EXPECT_EQ((map.elevation_m[{3, 4}]), 4);
  EXPECT_TRUE(std::isnan(map.elevation_m[{3, 2}]));
  EXPECT_DOUBLE_EQ(validFraction(map.elevation_m), 19.0 / 20);
  ASSERT_TRUE(map.georeference);
  EXPECT_EQ(map.georeference->body(), "Earth");
  EXPECT_THAT(map.georeference->system().name, HasSubstr("UTM zone 10N"));
}

// Closed form: the mean of two by two pixels, or of fewer pixels at the northern and eastern edge.
TEST(ElevationReader, OverviewCellsAreMeans) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .nodata = -1}, folder / "hill.tif");
  const ElevationMap map = readElevation(path, {.overview = 2});
  EXPECT_EQ(map.grid(), (Grid{.width = 2, .height = 3, .resolution_m = 20, .south_west = {500000, 4999950}}));
  EXPECT_EQ((map.elevation_m[{0, 0}]), (5 + 6 + 4 + 5) / 4.0F);
  EXPECT_EQ((map.elevation_m[{1, 0}]), (7 + 8 + 6 + 7) / 4.0F);
  EXPECT_EQ((map.elevation_m[{0, 1}]), (3 + 4 + 2 + 3) / 4.0F);
  EXPECT_EQ((map.elevation_m[{1, 1}]), (5 + 4 + 5) / 3.0F);  // one pixel without data
  EXPECT_EQ(elevationGrid(path, {.overview = 2}), map.grid());
}

// Property: every overview cell is the mean of the cells below it, and the overview covers the whole map,
// for either order of rows in the file.
TEST(ElevationReader, OverviewCoversTheWholeMap) {
  const TemporaryFolder folder;
  for (const double down : {-10.0, 10.0}) {
    RasterFile file{.rows = {}, .transform = std::array<double, 6>{500000, 10, 0, 5000000, 0, down}};
    for (int row = 0; row < 11; ++row) {
      file.rows.emplace_back();
      for (int column = 0; column < 7; ++column) file.rows.back().push_back(row * row + 3 * column);
    }
    const std::string path = write(file, folder / "plain.tif");
    const ElevationMap whole = readElevation(path);
    for (const int side : {2, 3, 4, 5}) {
      const ElevationMap overview = readElevation(path, {.overview = side});
      ASSERT_EQ(overview.grid().width, (7 + side - 1) / side);
      ASSERT_EQ(overview.grid().height, (11 + side - 1) / side);
      for (int row = 0; row < overview.grid().height; ++row)
        for (int column = 0; column < overview.grid().width; ++column) {
          double sum = 0.0;
          int count = 0;
          for (int y = row * side; y < std::min(11, (row + 1) * side); ++y)
            for (int x = column * side; x < std::min(7, (column + 1) * side); ++x, ++count)
              sum += static_cast<double>(whole.elevation_m[{x, y}]);
          EXPECT_NEAR(static_cast<double>(overview.elevation_m[{column, row}]), sum / count, 1e-4)
              << side << down;
        }
    }
  }
}

// A pixel scale below 0 in y is ambiguous: GDAL reads such a file as if its rows ran south.
TEST(ElevationReader, NegativeScaleOfRowsIsRefused) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill}, folder / "south.tif");
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const double scale[] = {10.0, 10.0, 0.0};
  const std::size_t at = bytes.find({reinterpret_cast<const char*>(scale), sizeof scale});
  ASSERT_NE(at, bytes.npos);
  bytes[at + 15] = static_cast<char>(bytes[at + 15] ^ '\x80');  // sign of the second number
  EXPECT_THAT(refusal([&] { readElevation(folder.write("north.tif", bytes)); }),
              HasSubstr("GDAL warns of its structure"));
}

TEST(ElevationReader, WindowInBareDegreesIsRefusedNamingTheSuffix) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill}, folder / "hill.tif");
  EXPECT_THAT(refusal([&] { readElevation(path, {.window = parseWindow("45.1,-123.1,45.2,-122.9")}); }),
              HasSubstr("latitudes and longitudes take the suffix d"));
  EXPECT_THAT(refusal([&] { readElevation(path, {.window = parseWindow("1000,1000,2000,2000")}); }),
              testing::Not(HasSubstr("suffix")));
}

// Property: of a plane, a single hole is interpolated exactly; at a step, beside another hole that leaves
// fewer than three pairs, or on request it stays unknown.
TEST(ElevationReader, SingleHolesAreInterpolatedWhereNeighboursAgree) {
  const TemporaryFolder folder;
  RasterFile plane{.rows = {}, .nodata = -1};
  for (int row = 0; row < 12; ++row) {
    plane.rows.emplace_back();
    for (int column = 0; column < 12; ++column) plane.rows.back().push_back(50 + 2 * column + 3 * row);
  }
  const auto holed = [&](std::initializer_list<std::pair<int, int>> holes, double step) {
    RasterFile file = plane;
    for (auto& row : file.rows)
      for (std::size_t c = 6; c < 12; ++c) row[c] += step;
    for (const auto& [row, column] : holes)
      file.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = -1;
    return write(file, folder / "holed.tif");
  };
  const ElevationMap map = readElevation(holed({{4, 4}}, 0.0));
  EXPECT_NEAR((map.elevation_m[{4, 7}]), 50 + 8 + 12, 1e-4);
  EXPECT_THAT(map.notes, Contains(HasSubstr("1 single cells without data interpolated")));
  EXPECT_LT(validFraction(readElevation(holed({{4, 4}}, 0.0), {.keep_holes = true}).elevation_m), 1.0);
  EXPECT_LT(validFraction(readElevation(holed({{4, 6}}, 8.0)).elevation_m), 1.0) << "at a step of 8 m";
  EXPECT_LT(validFraction(readElevation(holed({{4, 4}, {4, 5}, {5, 4}, {5, 5}}, 0.0)).elevation_m), 1.0);
}

// Property: the grid for windowed planning has the same limit on cells as a map that is read whole.
TEST(ElevationReader, MapGridIsLimitedByMaxCells) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill}, folder / "hill.tif");
  EXPECT_THAT(refusal([&] { elevationGrid(path, {.resolution_m = 1e-3}); }), HasSubstr("are too many"));
  EXPECT_THAT(refusal([&] { elevationGrid(path, {.max_cells = 19}); }), HasSubstr("raise --max-cells"));
  EXPECT_EQ(elevationGrid(path, {.max_cells = 20}).size(), 20U);
}

TEST(ElevationReader, EveryFormatYieldsTheSameMap) {
  const TemporaryFolder folder;
  // PDS4 has no false easting.
  const RasterFile mars{.rows = kHill,
                        .crs = "IAU_2015:49910",
                        .transform = std::array<double, 6>{8142400, 10, 0, -276500, 0, -10},
                        .nodata = -1};
  const ElevationMap expected = readElevation(write(mars, folder / "hill.tif"));
  for (const char* driver : {"AAIGrid", "ENVI", "PDS4", "VRT", "PNG"}) {
    RasterFile file = mars;
    file.driver = driver;
    std::string path = folder / (std::string("hill_") + driver + (file.driver == "PDS4" ? ".xml" : ".dat"));
    if (file.driver == "VRT") {
      path = folder / "hill.vrt";
      const GdalQuiet quiet;
      const std::unique_ptr<GDALDataset> source(GDALDataset::Open((folder / "hill.tif").c_str()));
      GDALDriver* vrt = GetGDALDriverManager()->GetDriverByName("VRT");
      delete vrt->CreateCopy(path.c_str(), source.get(), FALSE, nullptr, nullptr, nullptr);
    } else if (file.driver == "PNG") {
      file.type = GDT_UInt16;
      file.nodata = 65535;
      file.rows[2][3] = 65535;
      write(file, path = folder / "hill.png");
    } else {
      write(file, path);
    }
    const ElevationMap map = readElevation(path, {.allow_vrt = file.driver == "VRT"});
    EXPECT_EQ(map.grid(), expected.grid()) << driver;
    for (std::size_t i = 0; i < 20; ++i) {
      const float a = map.elevation_m.values()[i];
      const float b = expected.elevation_m.values()[i];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << driver << i;
    }
  }
}

TEST(ElevationReader, WindowEqualsThatPartOfTheMap) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .nodata = -1}, folder / "hill.tif");
  const ElevationMap whole = readElevation(path);
  const ElevationMap part = readElevation(path, {.window = parseWindow("500010,4999960,500030,4999990")});
  EXPECT_EQ(part.grid(),
            (Grid{.width = 2, .height = 3, .resolution_m = 10, .south_west = {500010, 4999960}}));
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 2; ++c) EXPECT_EQ((part.elevation_m[{c, r}]), (whole.elevation_m[{c + 1, r + 1}]));
  const GeoPoint a = whole.georeference->reverse({500011, 4999961});
  const GeoPoint b = whole.georeference->reverse({500029, 4999989});
  EXPECT_EQ(readElevation(path, {.window = Window{a, b}}).grid(), part.grid());
}

// Property: a window of a map that is resampled has the values of the whole map there. Tolerance: places are
// transformed within 0.001 pixels, and a pixel rises by 3.7 m at most.
TEST(ElevationReader, WindowOfAResampledMapEqualsThatPart) {
  const TemporaryFolder folder;
  RasterFile file{
      .rows = {}, .crs = "EPSG:4326", .transform = std::array<double, 6>{10.0, 3e-4, 0, 46.0, 0, -2e-4}};
  for (int row = 0; row < 150; ++row) {
    file.rows.emplace_back();
    for (int column = 0; column < 150; ++column)
      file.rows.back().push_back(500.0 + 30.0 * std::sin(0.1 * column) + 20.0 * std::cos(0.13 * row));
  }
  const std::string path = write(file, folder / "degrees.tif");
  const ElevationMap whole = readElevation(path);
  const Grid& g = whole.grid();
  const Point a = g.centre({60, 70}), b = g.centre({90, 95});
  const ElevationMap part = readElevation(path, {.window = Window{a, b}});
  ASSERT_EQ(part.grid().width, 31);
  for (int row = 0; row < part.grid().height; ++row)
    for (int column = 0; column < part.grid().width; ++column)
      EXPECT_NEAR((part.elevation_m[{column, row}]), (whole.elevation_m[{60 + column, 70 + row}]), 4e-3F);
}

TEST(ElevationReader, SouthUpRastersAreFlipped) {
  const TemporaryFolder folder;
  const ElevationMap up = readElevation(write({.rows = kHill}, folder / "north.tif"));
  auto turned = kHill;
  std::reverse(turned.begin(), turned.end());
  const ElevationMap down =
      readElevation(write({.rows = turned, .transform = std::array<double, 6>{500000, 10, 0, 4999950, 0, 10}},
                          folder / "south.tif"));
  EXPECT_EQ(down.grid(), up.grid());
  EXPECT_EQ(down.elevation_m.values(), up.elevation_m.values());
}

TEST(ElevationReader, CoarserResolutionIsTheMean) {
  const TemporaryFolder folder;
  const ElevationMap map = readElevation(
      write({.rows = drawn({"1133", "1133", "5577", "5577"})}, folder / "blocks.tif"), {.resolution_m = 20});
  EXPECT_EQ(map.elevation_m.values(), (std::vector<float>{5, 7, 1, 3}));
}

TEST(ElevationReader, InvalidInputYieldsAOneLineErrorWithARemedy) {
  const TemporaryFolder folder;
  const std::string good = write({.rows = kHill, .nodata = -1}, folder / "good.tif");
  const std::string ascii = write({.rows = kHill, .driver = "AAIGrid"}, folder / "cut.asc");
  std::filesystem::resize_file(ascii, std::filesystem::file_size(ascii) - 12);
  const std::string cut = write(
      {.rows = std::vector<std::vector<double>>(300, std::vector<double>(300, 1.0))}, folder / "cut.tif");
  std::filesystem::resize_file(cut, 5000);
  const std::string envi = write({.rows = kHill, .driver = "ENVI"}, folder / "cut.img");
  std::filesystem::resize_file(envi, 41);
  std::filesystem::create_directory(folder / "folder.tif");
  struct Case {
    std::string path;
    ReadOptions options;
    const char* says;
  };
  const std::vector<Case> cases{
      {folder / "none.tif", {}, "no such file"},
      {folder / "folder.tif", {}, "is a directory"},
      {folder.write("empty.tif", ""), {}, "is empty"},
      {folder.write("text.tif", "hello, this is no raster at all\n"), {}, "GDAL opens no raster"},
      {ascii, {}, "cut short"},
      {cut, {}, "cut short"},
      {envi, {}, "cut short"},
      {write({.rows = drawn({"...", "..."}), .nodata = -1}, folder / "void.tif"),
       {},
       "holds no data in any cell"},
      {write({.rows = {{5}}}, folder / "one.tif"), {}, "1 x 1 cells have no slope"},
      {write({.rows = kHill, .crs = ""}, folder / "nowhere.tif"), {}, "no CRS; pass --resolution METRES"},
      {good, {.ignore_crs = true}, "its cell size is unknown; pass --resolution"},
      {good, {.band = 2}, "band 2: no such band; it has 1 band"},
      {good, {.resolution_m = -3.0}, "--resolution: must be 0.001 to 1000000 metres"},
      {good, {.resolution_m = std::nan("")}, "--resolution"},
      {good,
       {.window = parseWindow("0,0,10,10")},
       "the window lies outside the map; it spans x 500000 to 500040 m"},
      {good, {.max_cells = 10}, "4 x 5 cells are too many; read a part with --window"},
      {write({.rows = kHill, .crs = "EPSG:4326", .transform = std::array<double, 6>{0, 10, 0, 50, 0, -10}},
             folder / "globe.tif"),
       {},
       "too large for one map in metres; read a part with --window"},
      {write({.rows = kHill, .crs = "+proj=ortho +R=3396190"}, folder / "beyond.tif"),
       {},
       "lies outside the range of its CRS"},
      {write({.rows = kHill, .crs = "", .transform = std::array<double, 6>{0, 8, 6, 0, 6, -8}},
             folder / "askew.tif"),
       {.resolution_m = 1.0},
       "its pixels are not square"},
      {write({.rows = kHill, .transform = std::array<double, 6>{0, 0, 0, 0, 0, 0}}, folder / "flat.tif"),
       {},
       "pixel size"},
  };
  for (const Case& c : cases) {
    const std::string line = refusal([&] { readElevation(c.path, c.options); });
    EXPECT_THAT(line, HasSubstr(c.says)) << c.path;
    EXPECT_THAT(line, testing::Not(HasSubstr("\n")));
    EXPECT_TRUE(line.find(c.path) != std::string::npos || line.starts_with("--resolution")) << line;
  }
}

TEST(ElevationReader, ReadsEveryRealMap) {
  const char* folder = std::getenv("TALUS_REAL_MAPS");
  TALUS_REQUIRE(folder != nullptr, "TALUS_REAL_MAPS is not set");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".tif" || entry.path().string().find("class") != std::string::npos)
      continue;
    const std::string path = entry.path().string();
    const std::string line = refusal([&] { readElevation(path); });
    const bool local = line.find("no CRS") != std::string::npos;
    const ElevationMap map =
        local ? readElevation(path, {.resolution_m = std::stod(line.substr(line.rfind(' ')))})
              : readElevation(path);
    EXPECT_GT(map.grid().size(), 10000U) << path;
    EXPECT_GT(validFraction(map.elevation_m), 0.15) << path;
    ++count;
  }
  EXPECT_GT(count, 0);
}

// Compares Georeference with PROJ's own transform of the same CRS, called through GDAL.

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

OGRSpatialReference reference(const std::string& definition) {
  OGRSpatialReference out;
  EXPECT_EQ(out.SetFromUserInput(definition.c_str()), OGRERR_NONE) << definition;
  out.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return out;
}

struct Case {
  std::string definition;
  std::vector<GeoPoint> places_deg;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.definition;
}

class AgainstProj : public testing::TestWithParam<Case> {};

TEST_P(AgainstProj, ForwardAndReverseMatchProj) {
  OGRSpatialReference crs = reference(GetParam().definition);
  std::unique_ptr<OGRSpatialReference> degrees(crs.CloneGeogCS());
  degrees->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> proj(
      OGRCreateCoordinateTransformation(degrees.get(), &crs));
  ASSERT_TRUE(proj);
  const Georeference ours = georeferenceAt(coordinateSystem(crs, "test"), {});
  const double metres = crs.GetLinearUnits();
  // PROJ's series of the authalic latitude is inverted to a millimetre.
  const double back_rad = ours.system().projection.method == ProjectionMethod::Foreign ? 2e-10 : 1e-11;
  for (const GeoPoint& place : GetParam().places_deg) {
    const double unit = crs.GetAngularUnits() / kDegree;
    double x = (place.longitude_rad - crs.GetPrimeMeridian()) / unit;
    double y = place.latitude_rad / unit;
    ASSERT_TRUE(proj->Transform(1, &x, &y));
    const GeoPoint radians{place.latitude_rad * kDegree, place.longitude_rad * kDegree};
    const Point p = ours.forward(radians);
    // Measured by others: PROJ 9.1.
    EXPECT_NEAR(p.x_m, x * metres, 1e-3) << place.latitude_rad << "," << place.longitude_rad;
    EXPECT_NEAR(p.y_m, y * metres, 1e-3) << place.latitude_rad << "," << place.longitude_rad;
    const GeoPoint back = ours.reverse(p);
    EXPECT_NEAR(back.latitude_rad, radians.latitude_rad, back_rad);
    EXPECT_NEAR(std::remainder(back.longitude_rad - radians.longitude_rad, 2 * std::numbers::pi), 0.0,
                back_rad);
  }
}

// Property: the coordinate system rebuilt from its parameters equals the original.
TEST_P(AgainstProj, SystemRoundTripsThroughItsParameters) {
  const CoordinateSystem first = coordinateSystem(reference(GetParam().definition), "test");
  if (first.projection.method == ProjectionMethod::Foreign) GTEST_SKIP() << "lives by its WKT";
  CoordinateSystem bare = first;
  bare.wkt.clear();
  const Georeference a(first);
  const Georeference b(coordinateSystem(spatialReference(first), "wkt"));
  const Georeference c(coordinateSystem(spatialReference(bare), "numbers"));
  EXPECT_EQ(b.system().name, first.name);
  for (const GeoPoint& place : GetParam().places_deg) {
    const GeoPoint radians{place.latitude_rad * kDegree, place.longitude_rad * kDegree};
    EXPECT_NEAR(a.forward(radians).x_m, b.forward(radians).x_m, 1e-6);
    if (first.planetocentric) continue;  // the parameters alone make a planetographic system
    EXPECT_NEAR(a.forward(radians).x_m, c.forward(radians).x_m, 1e-6);
    EXPECT_NEAR(a.forward(radians).y_m, c.forward(radians).y_m, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Projections, AgainstProj,
    testing::Values(
        Case{"EPSG:32610", {{46.5, -121.5}, {10, -124}, {70, -120}}},
        Case{"EPSG:32733", {{-23.5, 15.2}, {-1, 17}}},
        Case{"+proj=tmerc +lat_0=-4.6 +lon_0=137.4 +k=1 +a=3396190 +b=3376200", {{-4.7, 137.2}, {-5, 138}}},
        Case{"+proj=tmerc +lat_0=10 +lon_0=20 +k=1 +R=1737400", {{10.2, 20.2}, {8, 21}}},
        Case{"EPSG:3031", {{-75, 100}, {-89, -20}}}, Case{"EPSG:3413", {{75, 100}, {89, -20}}},
        Case{"EPSG:32661", {{85, 33}}},
        Case{"+proj=stere +lat_0=-90 +lon_0=0 +k=1 +R=1737400", {{-84.8, 126}, {-89.9, -100}}},
        Case{"+proj=stere +lat_0=-90 +lat_ts=-70 +lon_0=30 +a=3396190 +b=3376200", {{-84.8, 126}}},
        Case{"+proj=stere +lat_0=25 +lon_0=-46 +k=1 +R=1737400", {{25.1, -46.7}, {40, -20}}},
        Case{"+proj=stere +lat_0=18.4 +lon_0=77.5 +k=0.9996 +a=3396190 +b=3376200", {{18, 77}, {-10, 100}}},
        Case{"+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190", {{-4.6, 137.4}, {60, -170}}},
        Case{"+proj=eqc +lat_ts=25 +lon_0=180 +R=3394839.8 +x_0=1000 +y_0=-500", {{-4.6, 137.4}, {60, -170}}},
        Case{"+proj=eqc +lat_ts=-5 +lat_0=3 +lon_0=130 +a=3396190 +b=3376200", {{-4.6, 137.4}}},
        Case{"EPSG:2154", {{44, 4}, {49, -1}}},
        Case{"+proj=lcc +lat_1=40 +lat_0=40 +lon_0=5 +k_0=0.9999 +ellps=GRS80", {{44, 4}}},
        Case{"EPSG:5070", {{36.5, -84.2}, {45, -120}}},
        Case{"+proj=aea +lat_1=-20 +lat_2=-40 +lat_0=-30 +lon_0=60 +a=3396190 +b=3376200", {{-25, 66}}},
        Case{"+proj=lcc +lat_1=-20 +lat_2=-40 +lat_0=-30 +lon_0=60 +R=1737400", {{-25, 66}}},
        Case{"EPSG:6933", {{36.5, -84.2}, {-45, 120}}}, Case{"EPSG:3395", {{36.5, -84.2}}},
        Case{"+proj=merc +lat_ts=12 +lon_0=77 +a=3396190 +b=3376200", {{18, 77.5}, {-30, 90}}},
        Case{"+proj=merc +k=0.9 +lon_0=77 +R=1737400", {{18, 77.5}}}, Case{"EPSG:3035", {{44, 4}, {60, 30}}},
        Case{"+proj=laea +lat_0=-90 +lon_0=10 +a=3396190 +b=3376200", {{-80, 77.5}}},
        Case{"+proj=laea +lat_0=0 +lon_0=10 +R=1737400", {{-8, 17.5}}},
        Case{"+proj=aeqd +lat_0=40 +lon_0=10 +ellps=WGS84", {{44, 4}}},
        Case{"+proj=aeqd +lat_0=-40 +lon_0=10 +R=1737400", {{-44, 4}}},
        Case{"+proj=ortho +lat_0=25.047646 +lon_0=-46.76548 +R=1737400", {{25.06, -46.77}, {50, -80}}},
        Case{"+proj=ortho +lat_0=25 +lon_0=46 +a=3396190 +b=3376200", {{25.06, 46.77}, {50, 80}}},
        Case{"+proj=sinu +lon_0=120 +R=3396190", {{-44, 137}}},
        Case{"+proj=sinu +lon_0=10 +ellps=WGS84", {{44, 4}}},
        Case{"EPSG:2227", {{37.5, -121}}},  // US survey feet
        Case{"EPSG:27572", {{47, 3}}},      // prime meridian of Paris
        Case{"IAU_2015:49910", {{-4.6, 137.4}}}, Case{"IAU_2015:30135", {{-85, 30}}}));

TEST(SpatialReference, PlanetocentricLatitudesOnAnEllipsoidMatchProj) {
  // Measured by others: PROJ 9.1, IAU_2015:49912 to 49902.
  const Georeference ours(coordinateSystem(reference("IAU_2015:49912"), "test"));
  EXPECT_TRUE(ours.system().planetocentric);
  const GeoPoint place = ours.reverse({8000000, -300000});
  EXPECT_NEAR(place.latitude_rad / kDegree, -5.00207966055024, 1e-10);
  EXPECT_NEAR(place.longitude_rad / kDegree, 134.964838864922, 1e-10);
}

TEST(SpatialReference, SystemsWithoutEastNorthMetresAreRejected) {
  const auto refusal = [](const char* definition) {
    try {
      coordinateSystem(reference(definition), "map.tif");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal("EPSG:4326"), testing::HasSubstr("is not projected"));
  EXPECT_THAT(refusal("IAU_2015:49911"), testing::HasSubstr("has a westward x axis"));
}

Georeference at(const char* definition, Point point) {
  return georeferenceAt(coordinateSystem(reference(definition), "test"), std::array{point});
}

double off_m(const Georeference& georeference, Point point, GeoPoint stated_deg) {
  const GeoPoint place = georeference.reverse(point);
  return std::hypot(
             place.latitude_rad - stated_deg.latitude_rad * kDegree,
             (place.longitude_rad - stated_deg.longitude_rad * kDegree) * std::cos(place.latitude_rad)) *
         kEarth.equatorial_radius_m;
}

// Property: latitude and longitude on Earth are those of WGS 84 (GPS), whatever the datum of the map.
TEST(SpatialReference, GeographicCoordinatesOnEarthAreWgs84) {
  struct Known {
    const char* definition;
    Point point;
    GeoPoint wgs84_deg;
    double most_m;
  };
  // Printed in: swisstopo, "Formeln und Konstanten", origin of LV03 and LV95 in CHTRS95; Kadaster,
  // RDNAPTRANS, its origin; Ordnance Survey, "A guide to coordinate systems in Great Britain", example C.1 on
  // its own datum, whose WGS 84 position the transformation of seven parameters gives to 5 m.
  for (const Known& known : {Known{"EPSG:21781", {600000, 200000}, {46.951082877, 7.438632495}, 2.0},
                             Known{"EPSG:2056", {2600000, 1200000}, {46.951082877, 7.438632495}, 2.0},
                             Known{"EPSG:28992", {155000, 463000}, {52.15517440, 5.38720621}, 2.0},
                             Known{"EPSG:27700", {651409.903, 313177.270}, {52.657978, 1.716053}, 5.0}}) {
    const Georeference georeference = at(known.definition, known.point);
    EXPECT_EQ(georeference.system().projection.method, ProjectionMethod::Foreign) << known.definition;
    EXPECT_LE(off_m(georeference, known.point, known.wgs84_deg), known.most_m) << known.definition;
    // Tolerance: the seven-parameter transformation of EPSG and its inverse differ by a millimetre.
    const Point back = georeference.forward(georeference.reverse(known.point));
    EXPECT_NEAR(back.x_m, known.point.x_m, 2e-3) << known.definition;
    EXPECT_NEAR(back.y_m, known.point.y_m, 2e-3) << known.definition;
  }
  for (const char* other : {"EPSG:5514", "EPSG:31467", "EPSG:3857", "ESRI:54030"})
    EXPECT_TRUE(at(other, {}).reachesPlaces()) << other;
}

// Closed form: x = R lambda, y = R asinh(tan phi) on the sphere of the equatorial radius.
TEST(SpatialReference, WebMercatorIsSpherical) {
  const Point point{9e5, 6e6};
  const double r = kEarth.equatorial_radius_m;
  EXPECT_LE(off_m(at("EPSG:3857", point), point,
                  {std::atan(std::sinh(point.y_m / r)) / kDegree, point.x_m / r / kDegree}),
            1e-3);
}

// Property: the parameters stored for machines without PROJ agree with PROJ at the map's location.
TEST(SpatialReference, ParametersAreKeptForExactlySupportedProjections) {
  for (const char* own : {"EPSG:32610", "EPSG:3031", "EPSG:3413", "IAU_2015:49910", "IAU_2015:30135"})
    EXPECT_NE(at(own, {500000, 500000}).system().projection.method, ProjectionMethod::Foreign) << own;
  const Georeference pole = at("IAU_2015:49912", {8000000, -300000});
  EXPECT_TRUE(pole.system().planetocentric);
  EXPECT_NE(pole.system().projection.method, ProjectionMethod::Foreign);
}

TEST(SpatialReference, LocalProjectionHasUnitScaleAtItsCentre) {
  for (const char* definition :
       {"EPSG:4326", "EPSG:4277", "IAU_2015:49901", "IAU_2015:49902", "IAU_2015:30100"})
    for (double latitude_deg : {-88.0, -30.0, 0.0, 62.0}) {
      const GeoPoint centre{latitude_deg * kDegree, 100 * kDegree};
      const Georeference local = georeferenceAt(
          coordinateSystem(localProjection(reference(definition), centre), "test"), std::array{Point{}});
      EXPECT_NE(local.system().projection.method, ProjectionMethod::Foreign);
      const Point ground = local.groundScale(local.forward(centre));
      EXPECT_NEAR(ground.x_m, 1.0, 1e-3) << definition << latitude_deg;
      EXPECT_NEAR(ground.y_m, 1.0, 1e-3) << definition << latitude_deg;
      EXPECT_FALSE(local.system().planetocentric);
    }
}

}  // namespace elevation_reader_test
}  // namespace talus::maps
