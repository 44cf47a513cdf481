#include "layer_fixture.hpp"

namespace talus::maps {
namespace {

using testing::HasSubstr;

TEST(LayerReader, ClassesOnTheSameCells) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = drawn({"1122", "1.22", "3333"}), .type = GDT_Int16, .nodata = -1}, folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, map(folder))), "1122\n1.22\n3333\n");
}

TEST(LayerReader, FinerShiftedClassesAreTakenByTheNearest) {
  const TemporaryFolder folder;
  // Cells of 5 m that cover the eastern three columns.
  const std::string path = write({.rows = drawn({"112233", "112233", "112233", "112233", "445566", "445566"}),
                                  .transform = std::array<double, 6>{500010, 5, 0, 5000000, 0, -5},
                                  .type = GDT_Byte},
                                 folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, map(folder))), ".123\n.123\n.456\n");
}

TEST(LayerReader, ClassesInAnotherCrsAreCarriedOver) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const Georeference& g = *dem.georeference;
  // Degrees: a split between 1 and 2 along the meridian through x = 500020, which is not quite upright.
  const double middle_deg = g.reverse({500020, 4999985}).longitude_rad * 180 / 3.14159265358979;
  const std::string path =
      write({.rows = drawn({"12", "12"}),
             .crs = "EPSG:4326",
             .transform = std::array<double, 6>{middle_deg - 0.01, 0.01, 0, 45.16, 0, -0.01},
             .type = GDT_Byte},
            folder / "c.tif");
  EXPECT_EQ(drawing(readTerrainClasses({.path = path}, dem)), "1122\n1122\n1122\n");
}

TEST(LayerReader, WithoutACrsTheLayerHasTheMapsCoordinates) {
  const TemporaryFolder folder;
  const RasterFile file{.rows = drawn({"1234", "2345", "3456"}), .crs = "", .transform = std::nullopt};
  const ElevationMap local = readElevation(write(file, folder / "dem.tif"), {.resolution_m = 2.0});
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "dem.tif"}, local)), "1234\n2345\n3456\n");
  // The same size in a map with a CRS: cell upon cell.
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "dem.tif"}, map(TemporaryFolder()))),
            "1234\n2345\n3456\n");
}

// The greatest of what lies in a cell, whatever is not known or refused beside it.
TEST(LayerReader, FinerJoulesAreTakenByTheGreatest) {
  const TemporaryFolder folder;
  auto rows = drawn({"11223344", "15223349", "11223344", "11223344", "77777777", "77777777"});
  rows[0][2] = -1;        // no data in a quarter of a cell
  rows[2][4] = INFINITY;  // refused in a quarter of a cell
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
  EXPECT_EQ(added.dearest_J_per_m, 9.0F);
}

TEST(LayerReader, JoulesOnTheSameCellsAreExact) {
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
              HasSubstr("has no band 2"));
}

TEST(LayerReader, RockAbundanceFindsItsBandAndIsAShare) {
  const TemporaryFolder folder;
  auto rows = drawn({"0000", "0000", "0000"});
  for (auto& row : rows)
    for (double& v : row) v = -999.75;  // band 2 is 1000 more
  const std::string path = write({.rows = rows, .names = {"dem", "dlre_ra"}}, folder / "stack.tif");
  EXPECT_FLOAT_EQ((readRockAbundance({.path = path}, map(folder))[{2, 1}]), 0.25F);
  const std::string percent = write({.rows = drawn({"0090", "0000", "0000"})}, folder / "percent.tif");
  EXPECT_THAT(refusal([&] { readRockAbundance({.path = percent}, map(folder)); }),
              HasSubstr("rock abundance 9 is not a fraction from 0 to 1; divide percents by 100"));
}

TEST(LayerReader, BadLayersAreRefused) {
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

}  // namespace
}  // namespace talus::maps
