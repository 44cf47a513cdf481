#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/intake.hpp>

#include "layer_fixture.hpp"
#include "raster_fixture.hpp"

namespace talus::maps {
namespace layer_reader_test {

using testing::HasSubstr;

TEST(LayerReader, ClassesOnTheMapGridAreExact) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = drawn({"1122", "1.22", "3333"}), .type = GDT_Int16, .nodata = -1}, folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, map(folder))), "1122\n1.22\n3333\n");
}

// Property: complex numbers are rejected, because GDAL would omit the imaginary parts.
TEST(LayerReader, ComplexNumbersAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = readElevation(write({.rows = drawn({"1111", "1111", "1111"})}, folder / "d.tif"));
  for (const GDALDataType type : {GDT_CInt16, GDT_CInt32, GDT_CFloat32, GDT_CFloat64}) {
    const std::string path = write({.rows = drawn({"1111", "1111", "1111"}), .type = type}, folder / "c.tif");
    EXPECT_THAT(refusal([&] { readTerrainClasses({.path = path}, dem, {}); }), HasSubstr("complex"));
    EXPECT_THAT(refusal([&] { readAddedJoules({.path = path}, dem); }), HasSubstr("complex"));
    EXPECT_THAT(refusal([&] { readRockAbundance({.path = path}, dem); }), HasSubstr("complex"));
  }
}

// Closed form: an abundance of 7 with scale 0.01 and offset 0.1 is 0.17.
TEST(LayerReader, ScaleAndOffsetOfTheBandAreApplied) {
  const TemporaryFolder folder;
  const ElevationMap dem = readElevation(write({.rows = drawn({"1111", "1111", "1111"})}, folder / "d.tif"));
  const std::string path =
      write({.rows = drawn({"7777", "7777", "7777"}), .type = GDT_Byte, .scale = 0.01, .offset = 0.1},
            folder / "r.tif");
  EXPECT_FLOAT_EQ((readRockAbundance({.path = path}, dem).share[{1, 1}]), 0.17F);
}

TEST(LayerReader, FinerShiftedClassesAreAlignedToTheMap) {
  const TemporaryFolder folder;
  // Cells of 5 m that cover the eastern three columns.
  const std::string path = write({.rows = drawn({"112233", "112233", "112233", "112233", "445566", "445566"}),
                                  .transform = std::array<double, 6>{500010, 5, 0, 5000000, 0, -5},
                                  .type = GDT_Byte},
                                 folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, map(folder))), ".123\n.123\n.456\n");
}

// Property: the class equals that by brute force over every pixel that overlaps the cell, for random sizes,
// positions and orders.
TEST(LayerReader, ACellTakesTheWeakestClassOfOverlappingPixels) {
  std::mt19937 random(7);
  const auto among = [&random](int lowest, int highest) {
    return std::uniform_int_distribution(lowest, highest)(random);
  };
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  for (int run = 0; run < 40; ++run) {
    std::vector<int> weakest_last{0, 1, 2, 3, kNoClass};
    std::ranges::shuffle(weakest_last, random);
    const double side_m = among(2, 17), west_m = 500000 - among(1, 16), north_m = 5000000 + among(1, 16);
    const int width = static_cast<int>(60 / side_m) + 2, height = static_cast<int>(50 / side_m) + 2;
    std::vector rows(static_cast<std::size_t>(height), std::vector<double>(static_cast<std::size_t>(width)));
    for (auto& row : rows)
      for (double& v : row) v = among(0, 9) < 8 ? 0 : among(0, 4) * among(0, 1);
    for (auto& row : rows) std::ranges::replace(row, 4.0, -1.0);  // no data
    const std::string path =
        write({.rows = rows,
               .transform = std::array<double, 6>{west_m, side_m, 0, north_m, 0, -side_m},
               .type = GDT_Float32,
               .nodata = -1},
              folder / "c.tif");
    const Raster<std::uint8_t> read = readTerrainClasses({.path = path}, dem, weakest_last);
    const auto place = [&](int number) {
      return std::ranges::find(weakest_last, number < 0 ? kNoClass : number) - weakest_last.begin();
    };
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) {
        int weakest = weakest_last.front();
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            const double west = west_m + x * side_m, north = north_m - y * side_m;
            const bool meets = west < 500010 + 10 * column && west + side_m > 500000 + 10 * column &&
                               north > 4999970 + 10 * row && north - side_m < 4999980 + 10 * row;
            const int value =
                static_cast<int>(rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]);
            if (meets && place(value) > place(weakest)) weakest = value;
          }
        EXPECT_EQ((read[{column, row}]), weakest < 0 ? kNoClass : weakest)
            << run << ' ' << column << ' ' << row;
      }
  }
}

// Property: for a raster rotated by its geotransform or CRS, every point of a pixel has a class in the map
// that is no stronger, and no cell has a class without a point in the cell or its neighbours. Points form a
// fine lattice over each pixel.
TEST(LayerReader, RotatedPixelsAreFoundInEveryCellTheyOverlap) {
  std::mt19937 random(5);
  const TemporaryFolder folder;
  std::vector dem_rows(40, std::vector<double>(40));
  for (const double turn : {0.02, 0.17, 0.52, 0.785, 2.3}) {
    for (const double side_m : {1.0, 3.0, 14.0}) {
      const ElevationMap dem = readElevation(
          write({.rows = dem_rows, .transform = std::array<double, 6>{500000, 2, 0, 5000080, 0, -2}},
                folder / "d.tif"));
      const double c = std::cos(turn), s = std::sin(turn);
      const int count = static_cast<int>(120 / side_m);
      // Rotated about the centre of the map.
      const double half = 0.5 * count * side_m;
      const std::array<double, 6> affine{500040 - half * c - half * s,  side_m * c, side_m * s,
                                         5000040 - half * s + half * c, side_m * s, -side_m * c};
      std::vector rows(static_cast<std::size_t>(count), std::vector<double>(static_cast<std::size_t>(count)));
      for (auto& row : rows)
        for (double& v : row) v = random() % 6 == 0 ? static_cast<double>(random() % 3) : 0.0;
      const std::string path = write({.rows = rows, .transform = affine}, folder / "c.tif");
      const Raster<std::uint8_t> read = readTerrainClasses({.path = path}, dem);
      Raster<std::uint8_t> least(dem.grid(), 0), most(dem.grid(), 0);
      constexpr int kLattice = 24;
      for (int y = 0; y < count * kLattice; ++y)
        for (int x = 0; x < count * kLattice; ++x) {
          const double px = (x + 0.5) / kLattice, py = (y + 0.5) / kLattice;
          const auto cell = dem.grid().cellAt(
              {affine[0] + px * affine[1] + py * affine[2], affine[3] + px * affine[4] + py * affine[5]});
          if (!cell) continue;
          const auto value = static_cast<std::uint8_t>(
              rows[static_cast<std::size_t>(y / kLattice)][static_cast<std::size_t>(x / kLattice)]);
          least[*cell] = std::max(least[*cell], value);
          for (int row = std::max(0, cell->row - 1); row <= std::min(39, cell->row + 1); ++row)
            for (int column = std::max(0, cell->column - 1); column <= std::min(39, cell->column + 1);
                 ++column)
              most[{column, row}] = std::max(most[{column, row}], value);
        }
      int differ = 0;
      for (int row = 1; row < 39; ++row)
        for (int column = 1; column < 39; ++column) {
          const Cell cell{column, row};
          if (read[cell] == kNoClass) continue;
          EXPECT_GE(read[cell], least[cell]) << turn << ' ' << side_m << ' ' << column << ' ' << row;
          EXPECT_LE(read[cell], most[cell]) << turn << ' ' << side_m << ' ' << column << ' ' << row;
          differ += read[cell] != least[cell];
        }
      EXPECT_LT(differ, 60) << "slivers between the places of the lattice";
    }
  }
}

// Property: pixels of the size of a cell, or of an integer fraction of that size, affect only their cells,
// for any position of the map and any rounding.
TEST(LayerReader, RoundingDoesNotSpreadPixelsToNeighbourCells) {
  const TemporaryFolder folder;
  std::mt19937 random(11);
  for (const std::size_t parts : {std::size_t{1}, std::size_t{3}}) {
    for (const double side_m : {0.1, 0.3, 1.0 / 3.0, 0.7, 29.97}) {
      const double west_m = 400000 + 0.1 * static_cast<double>(random() % 1000000),
                   north_m = 5000000 + 0.1 * static_cast<double>(random() % 1000000);
      const auto of = [&](double size_m) {
        return std::array<double, 6>{west_m, size_m, 0, north_m, 0, -size_m};
      };
      std::vector rows(7, std::vector<double>(9)),
          finer(std::size_t{7} * parts, std::vector<double>(std::size_t{9} * parts));
      for (std::size_t y = 0; y < finer.size(); ++y)
        for (std::size_t x = 0; x < finer[y].size(); ++x)
          finer[y][x] = static_cast<double>((x / parts * 5 + y / parts * 3) % 7);
      const ElevationMap dem =
          readElevation(write({.rows = rows, .transform = of(side_m)}, folder / "d.tif"));
      const std::string path =
          write({.rows = finer, .transform = of(side_m / static_cast<double>(parts))}, folder / "c.tif");
      const Raster<std::uint8_t> read = readTerrainClasses({.path = path}, dem);
      ASSERT_EQ(read.grid().width, 9);
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 9; ++column)
          EXPECT_EQ((read[{column, 6 - row}]), (column * 5 + row * 3) % 7) << side_m << ' ' << parts;
    }
  }
}

// Closed form: one pixel of a sixteenth of a cell.
TEST(LayerReader, ACellTakesTheMaximumRockShareAndMarksUnseenPixels) {
  const TemporaryFolder folder;
  std::vector rows(12, std::vector<double>(16, 0.1));
  rows[5][6] = 0.9;
  rows[1][13] = -1;  // not seen
  rows[2][13] = 0.6;
  const std::string path = write({.rows = rows,
                                  .transform = std::array<double, 6>{500000, 2.5, 0, 5000000, 0, -2.5},
                                  .type = GDT_Float32,
                                  .nodata = -1},
                                 folder / "r.tif");
  const RockAbundance rocks = readRockAbundance({.path = path}, map(folder));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      const bool great = column == 1 && row == 1, hidden = column == 3 && row == 2;
      EXPECT_FLOAT_EQ((rocks.share[{column, row}]), great ? 0.9F : hidden ? 0.6F : 0.1F);
      EXPECT_EQ((rocks.unseen[{column, row}]) != 0, hidden);
    }
}

TEST(LayerReader, ClassesAreReprojectedToTheMapCrs) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const Georeference& g = *dem.georeference;
  // In degrees: a boundary between 1 and 2 along the meridian through x = 500020, which is slightly inclined
  // on the map.
  const double middle_deg = g.reverse({500020, 4999985}).longitude_rad * 180 / std::numbers::pi;
  const std::string path =
      write({.rows = drawn({"12", "12"}),
             .crs = "EPSG:4326",
             .transform = std::array<double, 6>{middle_deg - 0.01, 0.01, 0, 45.16, 0, -0.01},
             .type = GDT_Byte},
            folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, dem)), "1122\n1122\n1122\n");
}

TEST(LayerReader, LayerWithoutCrsUsesMapCoordinates) {
  const TemporaryFolder folder;
  const RasterFile file{.rows = drawn({"1234", "2345", "3456"}), .crs = "", .transform = std::nullopt};
  const ElevationMap local = readElevation(write(file, folder / "dem.tif"), {.resolution_m = 2.0});
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "dem.tif"}, local)), "1234\n2345\n3456\n");
  // A raster of the same size on a map without a CRS is matched cell by cell.
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "dem.tif"}, map(TemporaryFolder()))),
            "1234\n2345\n3456\n");
}

// Property: a cell has the maximum of its pixels, also beside unknown or impassable pixels.
TEST(LayerReader, FinerCostLayerIsReducedByMaximum) {
  const TemporaryFolder folder;
  auto rows = drawn({"11223344", "15223349", "11223344", "11223344", "77777777", "77777777"});
  rows[0][2] = -1;        // no data in a quarter of a cell
  rows[2][4] = INFINITY;  // impassable in a quarter of a cell
  rows[2][0] = -1;        // both
  rows[3][1] = INFINITY;
  const std::string path = write({.rows = rows,
                                  .transform = std::array<double, 6>{500000, 5, 0, 5000000, 0, -5},
                                  .type = GDT_Float32,
                                  .nodata = -1},
                                 folder / "j.tif");
  const AddedJoules added = readAddedJoules({.path = path}, map(folder));
  const auto at = [&](int column, int row) { return added.J_per_m[{column, row}]; };
  EXPECT_EQ(at(0, 2), 5.0F);
  EXPECT_TRUE(std::isnan(at(1, 2)));
  EXPECT_EQ(at(3, 2), 9.0F);
  EXPECT_EQ(at(0, 1), INFINITY);
  EXPECT_EQ(at(2, 1), INFINITY);
  EXPECT_EQ(at(2, 0), 7.0F);
  EXPECT_EQ(added.highest_J_per_m, 9.0F);
}

TEST(LayerReader, CostLayerOnTheMapGridIsExact) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = drawn({"1122", "1.22", "3333"}), .type = GDT_Float64, .nodata = -1}, folder / "j.tif");
  const AddedJoules added = readAddedJoules({.path = path}, map(folder));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      const char drawn = std::string("33331.221122")[static_cast<std::size_t>(4 * row + column)];
      const float value = added.J_per_m[{column, row}];
      EXPECT_TRUE(drawn == '.' ? std::isnan(value) : value == static_cast<float>(drawn - '0'))
          << column << ' ' << row;
    }
  const std::string less =
      write({.rows = {{0.0, 1.0}, {-0.5, 2.0}}, .type = GDT_Float32}, folder / "less.tif");
  EXPECT_THAT(refusal([&] { readAddedJoules({.path = less}, map(folder)); }),
              HasSubstr("value -0.5 J/m is not 0 to 1e6"));
  EXPECT_THAT(refusal([&] { readAddedJoules({.path = path, .band = 2}, map(folder)); }),
              HasSubstr("no such band"));
}

TEST(LayerReader, RockAbundanceBandIsFoundByNameAndMustBeAFraction) {
  const TemporaryFolder folder;
  auto rows = drawn({"0000", "0000", "0000"});
  for (auto& row : rows)
    for (double& v : row) v = -999.75;  // band 2 is larger by 1000
  const std::string path = write({.rows = rows, .names = {"dem", "dlre_ra"}}, folder / "stack.tif");
  EXPECT_FLOAT_EQ((readRockAbundance({.path = path}, map(folder)).share[{2, 1}]), 0.25F);
  const std::string percent = write({.rows = drawn({"0090", "0000", "0000"})}, folder / "percent.tif");
  EXPECT_THAT(refusal([&] { readRockAbundance({.path = percent}, map(folder)); }),
              HasSubstr("rock abundance 9 is not a fraction from 0 to 1; divide percents by 100"));
}

TEST(LayerReader, InvalidLayersAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const std::string afar =
      write({.rows = drawn({"11", "11"}), .transform = std::array<double, 6>{900000, 10, 0, 5000000, 0, -10}},
            folder / "afar.tif");
  EXPECT_THAT(refusal([&] { readTerrainClasses({.path = afar}, dem); }), HasSubstr("does not overlap map"));
  EXPECT_THAT(refusal([&] { readTerrainClasses({.path = folder / "none.tif"}, dem); }),
              HasSubstr("no such file"));
  auto rows = drawn({"1111", "1111", "1111"});
  rows[1][1] = 2.5;
  EXPECT_THAT(refusal([&] { readTerrainClasses({.path = write({.rows = rows}, folder / "half.tif")}, dem); }),
              HasSubstr("value 2.5 is not a class number (0 to 254)"));
  EXPECT_THAT(refusal([&] { readTerrainClasses({.path = folder / "half.tif", .band = 7}, dem); }),
              HasSubstr("no such band"));
}

TEST(KeepOutReader, EveryCellTouchedByAPolygonIsClosed) {
  const TemporaryFolder folder;
  const std::string path = folder.write("k.geojson", R"({"type":"FeatureCollection","crs":"local","features":[
    {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
      [[[500011,4999971],[500019,4999971],[500021,4999995],[500011,4999971]]]}}]})");
  EXPECT_EQ(drawing(readKeepOut(path, map(folder)).mask), "0110\n0110\n0100\n");
}

// Property: a polygon that extends far beyond the map is clipped first, and covers the same cells.
TEST(KeepOutReader, PolygonsBeyondTheMapAreClipped) {
  const TemporaryFolder folder;
  const auto cells = [&](const std::string& ring) {
    const std::string path =
        folder.write("k.geojson", R"({"type":"Polygon","crs":"local","coordinates":[[)" + ring + "]]}");
    return drawing(readKeepOut(path, map(folder)).mask);
  };
  EXPECT_EQ(cells("[500015,-1e12],[1e12,-1e12],[1e12,1e12],[500015,1e12],[500015,-1e12]"),
            "0111\n0111\n0111\n");
  EXPECT_EQ(cells("[-1e14,-1e14],[1e14,-1e14],[1e14,1e14],[-1e14,1e14],[-1e14,-1e14]"), "1111\n1111\n1111\n");
  EXPECT_THROW(cells("[1e9,1e9],[2e9,1e9],[2e9,2e9],[1e9,1e9]"), InputError);
}

TEST(KeepOutReader, DegreesAreConvertedOnTheBodyOfTheMap) {
  const TemporaryFolder folder;
  const ElevationMap mars =
      readElevation(write({.rows = drawn({"1234", "2345", "3456"}),
                           .crs = "IAU_2015:49910",
                           .transform = std::array<double, 6>{8142400, 10, 0, -276500, 0, -10}},
                          folder / "mars.tif"));
  const auto corner = [&](double x, double y) {
    const GeoPoint p = mars.georeference->reverse({x, y});
    return "[" + std::to_string(p.longitude_rad / kDegree) + "," + std::to_string(p.latitude_rad / kDegree) +
           "]";
  };
  const std::string ring = "[" + corner(8142401, -276501) + "," + corner(8142409, -276501) + "," +
                           corner(8142409, -276529) + "," + corner(8142401, -276529) + "," +
                           corner(8142401, -276501) + "]";
  const std::string path =
      folder.write("k.geojson", R"({"type":"MultiPolygon","coordinates":[[)" + ring + "]]}");
  EXPECT_EQ(drawing(readKeepOut(path, mars).mask), "1000\n1000\n1000\n");
}

TEST(KeepOutReader, InvalidFilesAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const auto line = [&](const std::string& content) {
    return refusal([&] { readKeepOut(folder.write("k.geojson", content), dem); });
  };
  EXPECT_THAT(line(""), HasSubstr("is empty"));
  EXPECT_THAT(line("{"), HasSubstr("is not JSON"));
  EXPECT_THAT(line("[1]"), HasSubstr("is not GeoJSON"));
  EXPECT_THAT(line(R"({"type":"Point","coordinates":[0,0]})"), HasSubstr("POINT is no Polygon"));
  EXPECT_THAT(line(R"({"type":"FeatureCollection","features":[]})"), HasSubstr("holds no Polygon"));
  EXPECT_THAT(line(R"({"type":"Polygon","coordinates":[[[0,0],[1,1]]]})"),
              HasSubstr("fewer than four positions"));
  EXPECT_THAT(line(R"({"type":"Polygon","coordinates":[[["a",0],[1,1],[1,0],[0,0]]]})"),
              HasSubstr("not an array of numbers"));
  EXPECT_THAT(line(R"({"type":"Polygon","coordinates":[[[500011,4999971],[1,1],[1,0],[0,0]]]})"),
              HasSubstr("not a longitude and latitude"));
  EXPECT_THAT(line(R"({"type":"Polygon","coordinates":[[[0,0],[1,1],[1,0],[0,0]]]})"),
              HasSubstr("no polygon overlaps map"));
  EXPECT_THAT(refusal([&] { readKeepOut(folder / "none.geojson", dem); }), HasSubstr("no such file"));
}

constexpr const char* kSquare =
    R"({"type":"Feature","properties":{"name":"rock"},"geometry":{"type":"Polygon","coordinates":
       [[[500012,4999982],[500018,4999982],[500018,4999988],[500012,4999988],[500012,4999982]]]}})";

std::string collection(const std::string& geometry) {
  return R"({"type":"FeatureCollection","crs":"local","features":[)" + std::string(kSquare) +
         R"(,{"type":"Feature","properties":{},"geometry":)" + geometry + "}]}";
}

// Property: every feature in a file with a valid feature covers cells or is rejected with its number,
// including rings drawn twice, of which an even-odd rule would cover the boundary only.
TEST(KeepOutReader, EveryFeatureClosesCellsOrIsRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const std::string ring =
      "[500001,4999971],[500039,4999971],[500039,4999999],[500001,4999999],[500001,4999971]";
  const auto file = [&](const std::string& geometry) {
    return folder.write("k.geojson", collection(geometry));
  };
  const auto polygon = [](const std::string& rings) {
    return R"({"type":"Polygon","coordinates":[)" + rings + "]}";
  };
  EXPECT_EQ(drawing(readKeepOut(file(polygon("[" + ring + "," + ring + "]")), dem).mask),
            "1111\n1111\n1111\n");
  const auto told = [&](const std::string& geometry) {
    return refusal([&] { readKeepOut(file(geometry), dem); });
  };
  EXPECT_THAT(told(polygon("[" + ring + "],[" + ring + "]")),
              HasSubstr("feature 2: the holes of a polygon cover all of it"));
  EXPECT_THAT(told(R"({"type":"LineString","coordinates":[)" + ring + "]}"),
              HasSubstr("feature 2: LINESTRING is no Polygon"));
  EXPECT_THAT(told(R"({"type":"Point","coordinates":[500001,4999971]})"), HasSubstr("feature 2: POINT"));
  EXPECT_THAT(told(R"({"type":"GeometryCollection","geometries":[)" + polygon("[" + ring + "]") +
                   R"(,{"type":"Point","coordinates":[500001,4999971]}]})"),
              HasSubstr("feature 2: POINT"));
  EXPECT_THAT(told("null"), HasSubstr("feature 2: has no geometry"));
  EXPECT_THAT(told(polygon("[[500001,4999971],[500020,4999990],[500010,4999980],[500001,4999971]]")),
              HasSubstr("feature 2: a polygon encloses no ground"));
}

// Property: a polygon outside the map is reported and not rejected, because one file may serve several maps.
TEST(KeepOutReader, PolygonOutsideTheMapIsReported) {
  const TemporaryFolder folder;
  const KeepOut areas =
      readKeepOut(folder.write("k.geojson",
                               collection(R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]]]})")),
                  map(folder));
  EXPECT_EQ(drawing(areas.mask), "0000\n0100\n0000\n");
  EXPECT_THAT(areas.notes, testing::ElementsAre("1 of 2 polygons lies beside the map: feature 2"));
  EXPECT_TRUE(
      readKeepOut(folder.write("one.geojson", R"({"type":"FeatureCollection","crs":"local","features":[)" +
                                                  std::string(kSquare) + "]}"),
                  map(folder))
          .notes.empty());
}

using testing::Contains;

TEST(Intake, AppliesScaleOffsetUnitAndIntegerTypes) {
  const TemporaryFolder folder;
  const ElevationMap scaled = readElevation(write(
      {.rows = kHill, .type = GDT_Int16, .nodata = -1, .scale = 0.5, .offset = 100}, folder / "scaled.tif"));
  EXPECT_FLOAT_EQ((scaled.elevation_m[{0, 0}]), 102.5F);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{3, 2}]));
  const ElevationMap feet = readElevation(write({.rows = kHill, .unit = "ft"}, folder / "feet.tif"));
  EXPECT_FLOAT_EQ((feet.elevation_m[{0, 0}]), 5 * 0.3048F);
  EXPECT_THAT(feet.notes, Contains(HasSubstr("'ft' (file) converted")));
  const ElevationMap twice = readElevation(folder / "feet.tif", {.vertical_scale = 2});
  EXPECT_FLOAT_EQ((twice.elevation_m[{0, 0}]), 10 * 0.3048F);
}

TEST(Intake, BodyRadiusIsSubtractedFromRadialHeights) {
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

TEST(Intake, UndeclaredNodataValuesAreNoData) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][0] = -9999;
  const ElevationMap map = readElevation(write({.rows = rows}, folder / "undeclared.tif"));
  EXPECT_TRUE(std::isnan(map.elevation_m[{0, 4}]));
  EXPECT_THAT(map.notes, Contains(HasSubstr("1 cells of -9999 treated as no data")));
  rows[0][0] = -3.4e38;
  EXPECT_TRUE(std::isnan(readElevation(write({.rows = rows}, folder / "huge.tif")).elevation_m[{0, 4}]));
  EXPECT_TRUE(std::isnan(readElevation(folder / "huge.tif", {.nodata = 8}).elevation_m[{3, 0}]));
}

struct Conversion {
  double scale = 0.0, offset_m = 0.0;
};

// The conversion of a band of two cells, 0 and 1, on a body of a radius [m].
Conversion codeOf(const std::string& unit, double offset, double radius_m, std::vector<std::string>& notes,
                  const ReadOptions& options = {}) {
  const Dataset raster = memoryRaster(2, 1);
  OGRSpatialReference crs;
  crs.SetGeogCS("body", "datum", "sphere", radius_m, 0.0);
  raster->SetSpatialRef(&crs);
  GDALRasterBand& band = *raster->GetRasterBand(1);
  band.SetUnitType(unit.c_str());
  band.SetOffset(offset);
  float one = 1.0F;
  EXPECT_EQ(band.RasterIO(GF_Write, 1, 0, 1, 1, &one, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
  Quantity heights(Kind::Height_m, *raster, 1, "map.tif", options);
  notes = heights.notes;
  const std::vector<float> at = heights.of({*raster, 1, wholeOf(*raster), "map.tif"});
  return {static_cast<double>(at[1]) - static_cast<double>(at[0]), static_cast<double>(at[0])};
}

// Closed form: an international foot is 0.3048 m, one of the US survey 1200/3937 m.
TEST(Intake, BandUnitsAreConvertedToMetresOrRefused) {
  const auto scale = [&](const char* unit, std::size_t said) {
    std::vector<std::string> notes;
    const double out = codeOf(unit, 0.0, 1737400.0, notes).scale;
    EXPECT_EQ(notes.size(), said) << unit;
    return out;
  };
  EXPECT_EQ(scale("", 0), 1.0);
  EXPECT_EQ(scale("Metre", 0), 1.0);
  EXPECT_EQ(scale("KM", 1), 1000.0);
  for (const char* unit : {"kilometre", "KILOMETERS", "Kilometer"}) EXPECT_EQ(scale(unit, 1), 1000.0) << unit;
  EXPECT_NEAR(scale("ft", 1), 0.3048, 1e-7);  // single precision
  EXPECT_NEAR(scale("US survey foot", 1), 1200.0 / 3937.0, 1e-7);
  std::vector<std::string> notes;
  for (const char* unit : {"yard", "furlong", "kilometr", "ms"})
    EXPECT_THAT(refusal([&] { codeOf(unit, 0.0, 1737400.0, notes); }),
                HasSubstr("which is no known unit; pass --vertical-scale"))
        << unit;
  EXPECT_NEAR(codeOf("yard", 0.0, 1737400.0, notes, {.vertical_scale = 0.9144}).scale, 0.9144, 1e-7);
}

// Property: an offset near the radius, in metres or kilometres, states the unit; a stated unit must agree.
TEST(Intake, OffsetNearTheRadiusSettlesTheUnit) {
  std::vector<std::string> notes;
  for (const char* unit : {"", "km"}) {
    const Conversion code = codeOf(unit, 1737.4, 1737400.0, notes);
    EXPECT_EQ(code.scale, 1000.0);
    EXPECT_NEAR(code.offset_m, 0.0, 1e-6);
  }
  EXPECT_NEAR(codeOf("", 1737410.0, 1737400.0, notes).offset_m, 10.0, 1e-6);
  EXPECT_EQ(codeOf("", 1500.0, 1737400.0, notes).offset_m, 1500.0);
  for (const auto& [unit, offset] : {std::pair{"m", 1737.4}, {"km", 1737400.0}, {"ft", 1737400.0}})
    EXPECT_THAT(refusal([&, unit = unit, offset = offset] { codeOf(unit, offset, 1737400.0, notes); }),
                HasSubstr("which is the body's radius in"));
}

TEST(Intake, ImplausibleScaleIsRefused) {
  const TemporaryFolder folder;
  for (const double scale : {0.0, 1e-9, -1e9})
    EXPECT_THAT(refusal([&] { readElevation(write({.rows = kHill, .scale = scale}, folder / "s.tif")); }),
                HasSubstr("the scale must be 1e-6 to 1e6"))
        << scale;
}

// A label of PDS3 and heights from 0 in steps of 0.001.
std::string pds3(const std::string& unit, const std::string& offset) {
  std::string text =
      "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 192\r\nFILE_RECORDS = 16\r\n"
      "LABEL_RECORDS = 4\r\n^IMAGE = 5\r\nOBJECT = TABLE\r\nUNIT = DEGREE\r\nEND_OBJECT = TABLE\r\n"
      "OBJECT = IMAGE\r\nLINES = 12\r\nLINE_SAMPLES = 48\r\nSAMPLE_TYPE = PC_REAL\r\nSAMPLE_BITS = 32\r\n" +
      unit + "OFFSET = " + offset + "\r\nEND_OBJECT = IMAGE\r\nEND\r\n";
  text.resize(768, ' ');
  for (int i = 0; i < 12 * 48; ++i) {
    const auto value = static_cast<float>(0.001 * i);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return text;
}

// GDAL reads no unit from labels of PDS3. Closed form: the step from cell to cell is 0.001 units.
TEST(Intake, UnitOfAPds3LabelIsRead) {
  const TemporaryFolder folder;
  const auto step = [&](const std::string& unit) {
    const auto z = readElevation(folder.write("h.img", pds3(unit, "0.0")), {.resolution_m = 5.0}).elevation_m;
    return (z[{1, 0}]) - (z[{0, 0}]);
  };
  EXPECT_NEAR(step("UNIT = KILOMETER\r\n"), 1.0F, 1e-3F);
  EXPECT_NEAR(step("UNIT = \"METER\"\r\n"), 0.001F, 1e-6F);
  EXPECT_NEAR(step(""), 0.001F, 1e-6F);
  EXPECT_THAT(refusal([&] { step("UNIT = PARSEC\r\n"); }), HasSubstr("'PARSEC', which is no known unit"));
}

// Special constants and the valid range of a label are no data; pixels that GDAL reads as other numbers are refused.
TEST(Intake, Pds3LabelIsHonouredOrRefused) {
  const TemporaryFolder folder;
  const auto valid = [&](const std::string& more) {
    return validFraction(
        readElevation(folder.write("h.img", pds3(more, "0.0")), {.resolution_m = 5.0, .keep_holes = true})
            .elevation_m);
  };
  EXPECT_EQ(valid(""), 1.0);
  EXPECT_DOUBLE_EQ(valid("UNKNOWN_CONSTANT = 0.25\r\n"), 1.0 - 1.0 / 576);
  EXPECT_DOUBLE_EQ(valid("VALID_MINIMUM = 0.0995\r\n"), 1.0 - 100.0 / 576);
  // Closed form: 20 m of the sphere of 1737.4 km are 1/1516.17 degrees.
  const std::string scale =
      "A_AXIS_RADIUS = 1737.4 <km>\r\nMAP_SCALE = 20 <METERS/PIXEL>\r\nMAP_RESOLUTION = ";
  EXPECT_EQ(valid(scale + "1516.17 <PIXEL/DEG>\r\n"), 1.0);
  EXPECT_THAT(refusal([&] { valid(scale + "758.1 <PIXEL/DEG>\r\n"); }),
              HasSubstr("pixels per degree that differ"));
  EXPECT_THAT(refusal([&] { valid("LINE_SUFFIX_BYTES = 4\r\n"); }),
              HasSubstr("which GDAL reads as other numbers"));
  std::string integers = pds3("", "0.0");
  integers.replace(integers.find("PC_REAL"), 7, "LSB_INTEGER");
  integers.erase(integers.find("END\r\n") + 5, 4);
  EXPECT_THAT(refusal([&] { readElevation(folder.write("i.img", integers), {.resolution_m = 5.0}); }),
              HasSubstr("holds pixels of SAMPLE_TYPE LSB_INTEGER and SAMPLE_BITS 32"));
}

// Closed form: value = number x scale + offset; the line says so.
TEST(Intake, ElevationIsNumberTimesScalePlusOffset) {
  const TemporaryFolder folder;
  const RasterFile file{
      .rows = {{-1, 0, 10}, {7, 2e30, 7}, {7, 7, 7}}, .nodata = -1.0, .scale = 0.5, .offset = 100.0};
  const ElevationMap map = readElevation(write(file, folder / "s.tif"), {.keep_holes = true});
  EXPECT_TRUE(std::isnan(map.elevation_m[{0, 2}]));
  EXPECT_EQ((map.elevation_m[{1, 2}]), 100.0F);
  EXPECT_EQ((map.elevation_m[{2, 2}]), 105.0F);
  EXPECT_TRUE(std::isnan(map.elevation_m[{1, 1}]));
  EXPECT_EQ(map.reading, "heights = raw x 0.5 + 100 m (unit assumed), no-data -1 (file)");
  EXPECT_THAT(refusal([&] {
                readElevation(write({.rows = {{2e5, 1}, {1, 1}}}, folder / "far.tif"));
              }),
              HasSubstr("beyond 131072 m"));
}

// Radii are heights on cells of 20 m, where their steps of 0.125 m do not show, not on cells of 1 m.
TEST(Intake, RadiiAreHeightsOnWideCells) {
  const TemporaryFolder folder;
  RasterFile file{.rows = {{1737500, 1737501}, {1737502, 1737503}}, .crs = "+proj=eqc +R=1737400"};
  file.transform = std::array<double, 6>{0, 20, 0, 0, 0, -20};
  const ElevationMap map = readElevation(write(file, folder / "radii.tif"));
  EXPECT_EQ((map.elevation_m[{0, 1}]), 100.0F);
  EXPECT_THAT(map.notes, Contains(HasSubstr("elevations are radii")));
  file.transform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  EXPECT_THAT(refusal([&] { readElevation(write(file, folder / "fine.tif")); }),
              HasSubstr("beyond 131072 m"));
}

// Two statements of a unit must agree: of the band, a vertical CRS (EPSG:6360 is NAVD88 in feet) and Zunits.
TEST(Intake, StatementsOfTheUnitMustAgree) {
  const TemporaryFolder folder;
  const auto stepOf = [&](const std::string& path) {
    const auto z = readElevation(path).elevation_m;
    return (z[{1, 0}]) - (z[{0, 0}]);
  };
  RasterFile file{.rows = kHill, .crs = "EPSG:32610+6360"};
  EXPECT_NEAR(stepOf(write(file, folder / "v.tif")), 1200.0F / 3937.0F, 1e-5F);
  file.unit = "m";
  EXPECT_THAT(refusal([&] { stepOf(write(file, folder / "both.tif")); }),
              HasSubstr("and in 'US survey foot'"));
  const std::string grid = folder.write("z.asc",
                                        "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n"
                                        "1 2 3\n1 2 3\n1 2 3\n");
  folder.write("z.prj", "Projection UTM\nZone 10\nDatum WGS84\nUnits METERS\nZunits FEET\nParameters\n");
  EXPECT_NEAR(stepOf(grid), 0.3048F, 1e-5F);
  folder.write("z.prj", "Projection UTM\nZone 10\nDatum WGS84\nUnits METERS\nZunits PARSEC\nParameters\n");
  EXPECT_THAT(refusal([&] { stepOf(grid); }), HasSubstr("'PARSEC', which is no known unit"));
}

// Property: a customary no-data value counts as no data only if it is the minimum of all values.
TEST(Intake, NodataMarkerCountsOnlyAsTheMinimumValue) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][0] = -9999, rows[1][1] = -10500;
  EXPECT_EQ((readElevation(write({.rows = rows}, folder / "trench.tif")).elevation_m[{0, 4}]), -9999.0F);
  // Beside a declared value, and two of them.
  rows[1][1] = -32768, rows[2][3] = -1;
  const ElevationMap two =
      readElevation(write({.rows = rows, .nodata = -1}, folder / "two.tif"), {.keep_holes = true});
  EXPECT_DOUBLE_EQ(validFraction(two.elevation_m), 17.0 / 20);
  EXPECT_THAT(two.notes,
              testing::IsSupersetOf({HasSubstr("1 cells of -9999"), HasSubstr("1 cells of -32768")}));
}

// Property: a void that the file does not declare is no data in every frame and scale to which the map is
// resampled, and no mean mixes it with ground.
TEST(Intake, UndeclaredVoidIsNoDataInEveryFrame) {
  const TemporaryFolder folder;
  std::vector<std::vector<double>> rows(40, std::vector<double>(40));
  for (std::size_t r = 0; r < 40; ++r)
    for (std::size_t c = 0; c < 40; ++c)
      rows[r][c] = r > 11 && r < 21 && c > 19 && c < 32 ? -32768.0 : 100.0 + 0.5 * static_cast<double>(r + c);
  using Transform = std::array<double, 6>;
  const RasterFile plain{.rows = rows, .type = GDT_Int16};
  RasterFile degrees = plain, oblong = plain, turned = plain, mercator = plain;
  degrees.crs = "EPSG:4326", degrees.transform = Transform{10.0, 2e-4, 0, 46.0, 0, -1.4e-4};
  oblong.transform = Transform{500000, 10, 0, 5000000, 0, -15};
  turned.transform = Transform{500000, 8, 6, 5000000, 6, -8};
  mercator.crs = "EPSG:3857", mercator.transform = Transform{1e6, 10, 0, 6e6, 0, -10};
  const double void_share = 9.0 * 12.0 / 1600.0;
  const auto expectVoid = [&](const RasterFile& file, const ReadOptions& options, double most) {
    const ElevationMap map = readElevation(write(file, folder / "void.tif"), options);
    EXPECT_THAT(map.notes, Contains(HasSubstr("108 cells of -32768 treated as no data"))) << file.crs;
    double least = 1e9, greatest = -1e9, unknown = 0;
    for (const float z : map.elevation_m.values()) {
      unknown += std::isnan(z) ? 1.0 : 0.0;
      if (std::isnan(z)) continue;
      least = std::min(least, static_cast<double>(z)), greatest = std::max(greatest, static_cast<double>(z));
    }
    EXPECT_GT(least, 98.0) << file.crs;
    EXPECT_LT(greatest, 142.0) << file.crs;
    unknown /= static_cast<double>(map.elevation_m.values().size());
    EXPECT_GT(unknown, 0.5 * void_share) << file.crs;
    EXPECT_LT(unknown, most) << file.crs;
  };
  expectVoid(plain, {}, 1.01 * void_share);
  expectVoid(plain, {.overview = 4}, void_share);
  expectVoid(plain, {.resolution_m = 25.0}, void_share);
  expectVoid(plain, {.resolution_m = 7.0}, 2.0 * void_share);
  for (const RasterFile& file : {degrees, oblong, mercator}) expectVoid(file, {}, 2.5 * void_share);
  expectVoid(turned, {}, 0.7);  // half of the square around a turned raster lies outside of it
}

TEST(Intake, BandNamedLikeElevationIsChosen) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .names = {"slope of dem", "DEM", "rocks"}}, folder / "stack.tif");
  const ElevationMap map = readElevation(path);
  EXPECT_EQ((map.elevation_m[{0, 0}]), 1005);
  EXPECT_THAT(map.notes, Contains(HasSubstr("took band 2 'DEM' of 3")));
  EXPECT_EQ((readElevation(path, {.band = 3}).elevation_m[{0, 0}]), 2005);
}

// Criteria for an elevation band, as the reader uses them.
BandCriteria wish(const std::string& path, std::optional<int> band = {}) {
  return {.path = path, .band = band, .words = {"elev", "dem"}, .others = {"slope"}};
}

TEST(Intake, RequestedBandElseTheFirstIsChosen) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .names = {"albedo", "slope of dem"}}, folder / "two.tif");
  const Dataset file = openRaster(path);
  std::vector<std::string> notes;
  EXPECT_EQ(chooseBand(*file, wish(path, 2), notes), 2);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(chooseBand(*file, wish(path), notes), 1);
  EXPECT_THAT(notes, testing::ElementsAre("took band 1 'albedo' of 2"));
  for (int band : {0, -1, 3})
    EXPECT_THAT(refusal([&] { chooseBand(*file, wish(path, band), notes); }),
                HasSubstr("no such band; it has 2 bands, from 1"));
}

TEST(Intake, ColourImageIsRejected) {
  const Dataset picture = memoryRaster(3, 3);
  picture->GetRasterBand(1)->SetColorInterpretation(GCI_RedBand);
  std::vector<std::string> notes;
  EXPECT_THAT(refusal([&] { chooseBand(*picture, wish("photo.png"), notes); }),
              HasSubstr("photo.png: is a colour image"));
  EXPECT_EQ(chooseBand(*picture, wish("photo.png", 1), notes), 1);
}

TEST(Intake, PixelsAreReadFirstRowFirst) {
  const TemporaryFolder folder;
  const Dataset file = openRaster(write({.rows = kHill}, folder / "hill.tif"));
  EXPECT_THAT(Quantity().of({*file, 1, {.column = 1, .row = 0, .width = 2, .height = 2}, "a"}),
              testing::ElementsAre(2, 3, 3, 4));
  EXPECT_THAT(refusal([&] { RawPixels(*file, 1, {.column = 3, .row = 0, .width = 2, .height = 2}, "a"); }),
              HasSubstr("a: cannot be read to its end"));
}

TEST(Intake, MaskedAndInfinitePixelsAreNan) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][1] = std::numeric_limits<double>::infinity();
  const Dataset file = openRaster(write({.rows = rows}, folder / "masked.tif"));
  const Dataset copy(static_cast<GDALDataset*>(GetGDALDriverManager()->GetDriverByName("MEM")->CreateCopy(
      "", file.get(), FALSE, nullptr, nullptr, nullptr)));
  ASSERT_EQ(copy->CreateMaskBand(GMF_PER_DATASET), CE_None);
  std::vector<unsigned char> mask(20, 255);
  mask[0] = 0;
  ASSERT_EQ(copy->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 4, 5, mask.data(), 4, 5, GDT_Byte,
                                                            0, 0, nullptr),
            CE_None);
  Quantity heights(Kind::Height_m, *copy, 1, "a");
  const std::vector<float> values = heights.of({*copy, 1, wholeOf(*copy), "a"});
  EXPECT_THAT(heights.reading(), HasSubstr(", mask 5 %"));
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 3.0F);
}

TEST(Intake, NorthUpReversesTheRows) {
  const Grid grid{.width = 2, .height = 3};
  EXPECT_THAT(northUp(grid, {1, 2, 3, 4, 5, 6}).values(), testing::ElementsAre(5, 6, 3, 4, 1, 2));
}

}  // namespace layer_reader_test
}  // namespace talus::maps
