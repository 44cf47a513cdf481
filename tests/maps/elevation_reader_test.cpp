#include <cmath>
#include <cstdlib>

#include <talus/maps/elevation_reader.hpp>
#include <talus/talus.hpp>

#include "raster_fixture.hpp"
#include "requirement.hpp"

namespace talus::maps {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::vector<std::vector<double>> kHill = drawn({"1234",  //
                                                      "2345",  //
                                                      "345.",  //
                                                      "4567",  //
                                                      "5678"});

TEST(ElevationReader, RowsBecomeSouthFirstAndNodataNaN) {
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

// Closed form: the mean of two by two pixels; what is left over in the north and east is left out.
TEST(ElevationReader, AnOverviewHoldsMeans) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .nodata = -1}, folder / "hill.tif");
  const ElevationMap map = readElevation(path, {.overview = 2});
  EXPECT_EQ(map.grid(), (Grid{.width = 2, .height = 2, .resolution_m = 20, .south_west = {500000, 4999950}}));
  EXPECT_EQ((map.elevation_m[{0, 0}]), (5 + 6 + 4 + 5) / 4.0F);
  EXPECT_EQ((map.elevation_m[{1, 0}]), (7 + 8 + 6 + 7) / 4.0F);
  EXPECT_EQ((map.elevation_m[{0, 1}]), (3 + 4 + 2 + 3) / 4.0F);
  EXPECT_EQ((map.elevation_m[{1, 1}]), (5 + 4 + 5) / 3.0F);  // one pixel without data
  EXPECT_EQ(elevationGrid(path, {.overview = 2}), map.grid());
}

TEST(ElevationReader, EveryFormatGivesTheSameMap) {
  const TemporaryFolder folder;
  // PDS4 holds no false easting.
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
    const ElevationMap map = readElevation(path);
    EXPECT_EQ(map.grid(), expected.grid()) << driver;
    for (std::size_t i = 0; i < 20; ++i) {
      const float a = map.elevation_m.values()[i];
      const float b = expected.elevation_m.values()[i];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << driver << i;
    }
  }
}

TEST(ElevationReader, ScaleOffsetUnitAndIntegers) {
  const TemporaryFolder folder;
  const ElevationMap scaled = readElevation(write(
      {.rows = kHill, .type = GDT_Int16, .nodata = -1, .scale = 0.5, .offset = 100}, folder / "scaled.tif"));
  EXPECT_FLOAT_EQ((scaled.elevation_m[{0, 0}]), 102.5F);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{3, 2}]));
  const ElevationMap feet = readElevation(write({.rows = kHill, .unit = "ft"}, folder / "feet.tif"));
  EXPECT_FLOAT_EQ((feet.elevation_m[{0, 0}]), 5 * 0.3048F);
  EXPECT_THAT(feet.notes, Contains(HasSubstr("ft converted")));
  const ElevationMap twice = readElevation(folder / "feet.tif", {.vertical_scale = 2});
  EXPECT_FLOAT_EQ((twice.elevation_m[{0, 0}]), 10 * 0.3048F);
}

TEST(ElevationReader, HeightsFromTheBodysCentreLoseItsRadius) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill,
                                  .crs = "IAU_2015:30135",
                                  .transform = std::array<double, 6>{1000, 10, 0, 1000, 0, -10},
                                  .type = GDT_Int16,
                                  .scale = 0.5,
                                  .offset = 1737400},
                                 folder / "ldem.tif");
  EXPECT_FLOAT_EQ((readElevation(path).elevation_m[{0, 0}]), 2.5F);
}

TEST(ElevationReader, TakesTheBandNamedLikeElevation) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .names = {"slope of dem", "DEM", "rocks"}}, folder / "stack.tif");
  const ElevationMap map = readElevation(path);
  EXPECT_EQ((map.elevation_m[{0, 0}]), 1005);
  EXPECT_THAT(map.notes, Contains(HasSubstr("took band 2 'DEM' of 3")));
  EXPECT_EQ((readElevation(path, {.band = 3}).elevation_m[{0, 0}]), 2005);
}

TEST(ElevationReader, UndeclaredMarksAreNoData) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][0] = -9999;
  const ElevationMap map = readElevation(write({.rows = rows}, folder / "undeclared.tif"));
  EXPECT_TRUE(std::isnan(map.elevation_m[{0, 4}]));
  EXPECT_THAT(map.notes, Contains(HasSubstr("1 cells of -9999 taken as no data")));
  rows[0][0] = -3.4e38;
  EXPECT_TRUE(std::isnan(readElevation(write({.rows = rows}, folder / "huge.tif")).elevation_m[{0, 4}]));
  EXPECT_TRUE(std::isnan(readElevation(folder / "huge.tif", {.nodata = 8}).elevation_m[{3, 0}]));
}

TEST(ElevationReader, WindowIsTheSamePartOfTheMap) {
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

TEST(ElevationReader, SouthUpRastersAreTurned) {
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

TEST(ElevationReader, WithoutACrsTheResolutionMustBeGiven) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .crs = "", .transform = std::array<double, 6>{-20, 0.5, 0, 30, 0, -0.5}},
            folder / "yard.tif");
  const ElevationMap map = readElevation(path, {.resolution_m = 0.5});
  EXPECT_FALSE(map.georeference);
  EXPECT_EQ(map.grid(), (Grid{.width = 4, .height = 5, .resolution_m = 0.5, .south_west = {-20, 27.5}}));
  // A pixel size that is not the one stated: the file's coordinates mean nothing.
  EXPECT_EQ(readElevation(path, {.resolution_m = 0.1}).grid().south_west, (Point{0, 0}));
  const std::string bogus = write({.rows = kHill, .crs = "EPSG:4326"}, folder / "bogus.tif");
  EXPECT_EQ(readElevation(bogus, {.resolution_m = 2.0, .ignore_crs = true}).grid().resolution_m, 2.0);
}

// A cone of 20 degrees on a map of degrees keeps its slope once it is in metres.
TEST(ElevationReader, DegreesBecomeTrueMetresOnEachBody) {
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

TEST(ElevationReader, ObliqueAndOblongPixelsAreResampled) {
  const TemporaryFolder folder;
  std::vector<std::vector<double>> rows(40, std::vector<double>(40));
  const std::array<double, 6> turned{500000, 8, 6, 5000000, 6, -8};
  for (int r = 0; r < 40; ++r)
    for (int c = 0; c < 40; ++c)
      rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = 0.1 * ((c + 0.5) * 8 + (r + 0.5) * 6);
  const ElevationMap map = readElevation(write({.rows = rows, .transform = turned}, folder / "turned.tif"));
  EXPECT_NEAR(map.grid().resolution_m, 10, 1e-9);
  EXPECT_THAT(map.notes, Contains(HasSubstr("resampled to square cells of 10 m")));
  // Closed form: height is a tenth of the way east.
  EXPECT_NEAR(elevationAt(map.elevation_m, {500280, 5000000}).value(), 28.0, 0.01);
  EXPECT_NEAR(elevationAt(map.elevation_m, {500300, 4999990}).value(), 30.0, 0.01);
}

TEST(ElevationReader, StretchedProjectionsAreMadeTrue) {
  const TemporaryFolder folder;
  // At 60 degrees north this projection shows a metre of ground as two from west to east.
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

TEST(ElevationReader, CoarserOnRequestIsTheMean) {
  const TemporaryFolder folder;
  const ElevationMap map = readElevation(
      write({.rows = drawn({"1133", "1133", "5577", "5577"})}, folder / "blocks.tif"), {.resolution_m = 20});
  EXPECT_EQ(map.elevation_m.values(), (std::vector<float>{5, 7, 1, 3}));
}

TEST(ElevationReader, BadInputIsOneLineWithARemedy) {
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
      {folder.write("half.npz", "PK\x03\x04 half"), {}, "is no NumPy archive"},
      {folder.write("text.npy", "hello, this is no array"), {}, "not a NumPy array"},
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
      {good, {.resolution_m = -3.0}, "--resolution: must be a number of metres above 0"},
      {good, {.resolution_m = std::nan("")}, "--resolution"},
      {good,
       {.window = parseWindow("0,0,10,10")},
       "the window lies outside the map; it spans x 500000 to 500040 m"},
      {good, {.max_cells = 10}, "4 x 5 cells are too many; read a part with --window"},
      {write({.rows = kHill, .crs = "EPSG:4326", .transform = std::array<double, 6>{0, 10, 0, 50, 0, -10}},
             folder / "globe.tif"),
       {},
       "too much for one map in metres; read a part with --window"},
      {write({.rows = kHill, .crs = "+proj=robin +R=3396190"}, folder / "robin.tif"),
       {},
       "projection 'Robinson'"},
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

// Property: whatever the bytes, a file is read or refused in one line; nothing else comes out.
TEST(ElevationReader, DamagedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  const std::string good = write({.rows = kHill, .nodata = -1}, folder / "good.tif");
  std::ifstream file(good, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(file)), {});
  std::uint32_t random = 1;
  const auto next = [&random](std::size_t below) {
    random = random * 1664525U + 1013904223U;
    return static_cast<std::size_t>(random >> 8) % below;
  };
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    for (std::size_t n = 1 + next(3); n > 0; --n) bytes[next(bytes.size())] = static_cast<char>(next(256));
    if (i % 5 == 0) bytes.resize(1 + next(bytes.size()));
    const std::string path = folder.write("damaged.tif", bytes);
    testing::internal::CaptureStderr();
    const std::string line = refusal([&] { readElevation(path, {.max_cells = 1'000'000}); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_THAT(line, testing::AnyOf("accepted", HasSubstr(path)));
    EXPECT_THAT(line, testing::Not(HasSubstr("another error")));
  }
}

TEST(ElevationReader, ReadsTheMapOfJacksboroThatMatplotlibShips) {
  const std::string path = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz";
  TALUS_REQUIRE(std::filesystem::exists(path), "python-matplotlib-data is not installed");
  const ElevationMap map = readElevation(path);
  EXPECT_THAT(map.notes, Contains(HasSubstr("ymin and ymax are in the wrong order")));
  // Printed in: the file. 403 x 344 cells of 3 arc seconds about 36.59 N, 84.25 W, heights 238 to 1076 m.
  const Point middle = map.georeference->forward({36.5895833 * kDegree, -84.2458333 * kDegree});
  EXPECT_NEAR(middle.x_m, 0, 1);
  EXPECT_NEAR(middle.y_m, 0, 1);
  EXPECT_NEAR(map.grid().width * map.grid().resolution_m, 30100, 150);
  EXPECT_NEAR(map.grid().height * map.grid().resolution_m, 31850, 150);
  // Row 20 of column 30 holds 507 m, which is found in the north only when the limits are swapped back.
  const Point inside = map.georeference->forward({36.7158333 * kDegree, -84.3883333 * kDegree});
  EXPECT_NEAR(elevationAt(map.elevation_m, inside).value(), 507,
              8);  // between cells: neighbours differ by that
}

TEST(ElevationReader, ReadsEveryRealMap) {
  const char* folder = std::getenv("TALUS_REAL_MAPS");
  TALUS_REQUIRE(folder != nullptr, "TALUS_REAL_MAPS is not set");
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".tif" || entry.path().string().find("class") != std::string::npos)
      continue;
    const std::string path = entry.path().string();
    const bool local = refusal([&] { readElevation(path); }).find("no CRS") != std::string::npos;
    const ElevationMap map = local ? readElevation(path, {.resolution_m = 1.0}) : readElevation(path);
    EXPECT_GT(map.grid().size(), 10000U) << path;
    EXPECT_GT(validFraction(map.elevation_m), 0.15) << path;
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace talus::maps
