#include <cmath>

#include <talus/maps/elevation_reader.hpp>
#include <talus/maps/geotiff_writer.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/place_reader.hpp>
#include <talus/talus.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace {

using testing::HasSubstr;

// 4 x 3 cells of 10 m, UTM.
ElevationMap map(const TemporaryFolder& folder) {
  return readElevation(write({.rows = drawn({"1234", "2345", "3456"})}, folder / "dem.tif"));
}

std::string drawing(const Raster<std::uint8_t>& classes) {
  std::string out;
  for (int row = classes.grid().height - 1; row >= 0; --row) {
    for (int column = 0; column < classes.grid().width; ++column) {
      const int value = classes[{column, row}];
      out += value == kNoClass ? '.' : static_cast<char>('0' + value);
    }
    out += '\n';
  }
  return out;
}

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

TEST(KeepOut, EveryCellThatAnAreaTouches) {
  const TemporaryFolder folder;
  const std::string path = folder.write("k.geojson", R"({"type":"FeatureCollection","crs":"local","features":[
    {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
      [[[500011,4999971],[500019,4999971],[500021,4999995],[500011,4999971]]]}}]})");
  EXPECT_EQ(drawing(readKeepOut(path, map(folder))), "0110\n0110\n0100\n");
}

TEST(KeepOut, DegreesOnTheMapsOwnBody) {
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
  EXPECT_EQ(drawing(readKeepOut(path, mars)), "1000\n1000\n1000\n");
}

TEST(KeepOut, BadFilesAreRefused) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const auto line = [&](const std::string& content) {
    return refusal([&] { readKeepOut(folder.write("k.geojson", content), dem); });
  };
  EXPECT_THAT(line(""), HasSubstr("is empty"));
  EXPECT_THAT(line("{"), HasSubstr("is not JSON"));
  EXPECT_THAT(line("[1]"), HasSubstr("is not GeoJSON"));
  EXPECT_THAT(line(R"({"type":"Point","coordinates":[0,0]})"), HasSubstr("holds no Polygon"));
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

TEST(PlaceReader, FirstPointOfAGeoJsonFile) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const std::string local = folder.write("p.geojson", R"({"type":"Feature","crs":"local","properties":{},
      "geometry":{"type":"Point","coordinates":[500015,4999985,3]}})");
  EXPECT_EQ(readPlace(local, dem, "--start"), (Point{500015, 4999985}));
  const std::string degrees =
      folder.write("d.geojson", R"({"type":"Point","coordinates":[-122.99981,45.15335]})");
  const Point p = readPlace(degrees, dem, "--start");
  EXPECT_NEAR(p.x_m, 500015, 1);
  EXPECT_EQ(readPlace("500015,4999985", dem, "--start"), (Point{500015, 4999985}));
  EXPECT_THAT(refusal([&] { readPlace("500015", dem, "--start"); }),
              HasSubstr("--start 500015: has not 2 numbers"));
  EXPECT_THAT(refusal([&] { readPlace("1,2", dem, "--goal"); }),
              HasSubstr("--goal 1,2: x 1 m, y 2 m lies outside the map"));
  EXPECT_THAT(refusal([&] { readPlace(folder / "none.geojson", dem, "--goal"); }), HasSubstr("no such file"));
  const std::string line = folder.write("l.geojson", R"({"type":"LineString","coordinates":[[0,0],[1,1]]})");
  EXPECT_THAT(refusal([&] { readPlace(line, dem, "--goal"); }), HasSubstr("holds no Point"));
}

TEST(GeoTiffWriter, WhatIsWrittenIsReadBack) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  Raster<float> slope(dem.grid(), 0.5F);
  slope[{1, 2}] = std::numeric_limits<float>::quiet_NaN();
  const std::string path = folder / "layers.tif";
  writeGeoTiff({path, &*dem.georeference}, {{"elevation", "m", dem.elevation_m}, {"slope", "", slope}});
  const ElevationMap back = readElevation(path);
  EXPECT_EQ(back.grid(), dem.grid());
  EXPECT_EQ(back.elevation_m.values(), dem.elevation_m.values());
  EXPECT_EQ(back.georeference->system().name, dem.georeference->system().name);
  const ElevationMap second = readElevation(path, {.band = 2});
  EXPECT_TRUE(std::isnan(second.elevation_m[{1, 2}]));
  EXPECT_EQ((second.elevation_m[{0, 0}]), 0.5F);
  Raster<std::uint8_t> classes(dem.grid(), 3);
  classes[{0, 0}] = kNoClass;
  writeGeoTiff({folder / "classes.tif", &*dem.georeference}, "class", classes, kNoClass);
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "classes.tif"}, dem)), "3333\n3333\n.333\n");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()))
    files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 3) << "no file may be left beside";
}

TEST(GeoTiffWriter, RefusesWhatCannotBeWritten) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  EXPECT_THAT(refusal([&] {
                writeGeoTiff({folder / "no/where.tif"}, {{"z", "m", dem.elevation_m}});
              }),
              HasSubstr("cannot be written"));
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {}), std::invalid_argument);
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {{"z", "m", dem.elevation_m},
                                                 {"s", "", Raster<float>(Grid{.width = 2, .height = 2})}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace talus::maps
