#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>

#include "layer_fixture.hpp"

namespace talus::maps {
namespace keep_out_reader_test {

using testing::HasSubstr;

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

}  // namespace keep_out_reader_test
}  // namespace talus::maps
