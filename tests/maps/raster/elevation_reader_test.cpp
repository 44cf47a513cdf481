#include <cmath>
#include <cstdlib>

#include <talus/maps/maps_io.hpp>

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

}  // namespace elevation_reader_test
}  // namespace talus::maps
