#include <talus/maps/vector/place_reader.hpp>

#include "layer_fixture.hpp"

namespace talus::maps {
namespace place_reader_test {

using testing::HasSubstr;

TEST(PlaceReader, PlaceIsThePointOfAGeoJsonFile) {
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

TEST(PlaceReader, FirstOfSeveralPointsIsUsed) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  const std::string many = folder.write(
      "m.geojson",
      R"({"type":"MultiPoint","crs":"local","coordinates":[[500015,4999985],[500025,4999975]]})");
  EXPECT_EQ(readPlace(many, dem, "--start"), (Point{500015, 4999985}));
  const std::string empty =
      folder.write("e.geojson", R"({"type":"MultiPoint","crs":"local","coordinates":[]})");
  EXPECT_THAT(refusal([&] { readPlace(empty, dem, "--start"); }), HasSubstr("holds no Point"));
}

}  // namespace place_reader_test
}  // namespace talus::maps
