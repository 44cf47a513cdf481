#include <fmt/format.h>

#include <talus/cli/ground/path_reader.hpp>
#include <talus/common/common.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace path_reader_test {

using maps::Point;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

maps::ElevationMap placedMap() {
  maps::ElevationMap map = exampleMap();
  map.georeference.emplace(maps::CoordinateSystem{.name = "site", .ellipsoid = maps::kEarth});
  return map;
}

std::vector<Point> read(const std::string& name, const std::string& content) {
  const Folder folder;
  return readPath(folder.write(name, content), exampleMap());
}

TEST(PathReader, TablesAreReadWithColumnsInAnyOrder) {
  EXPECT_THAT(read("p.csv", "name,y_m,x_m\na,2,1\nb,4.5,3e1\n"), ElementsAre(Point{1, 2}, Point{30, 4.5}));
  EXPECT_THAT(read("p.TXT", "x_m,y_m\n1,2\n"), ElementsAre(Point{1, 2}));
}

// Property: the names of the columns state the frame, in any case and with units. Degrees are those of the
// georeference of the map; without names of degrees they are refused.
TEST(PathReader, ColumnNamesStateTheFrame) {
  for (const char* table :
       {"X,Y\n1,2\n", "x [m],y [m]\n1,2\n", "Easting,Northing\n1,2\n", "Y_M;X_M\n2;1\n", "x\ty\n1\t2\n"})
    EXPECT_THAT(read("p.csv", table), ElementsAre(Point{1, 2})) << table;
  const maps::GeoPoint place = placedMap().georeference->reverse({1300, 2100});
  const std::string lat = fmt::format("{:.12f}", place.latitude_rad / kDegree),
                    lon = fmt::format("{:.12f}", place.longitude_rad / kDegree);
  const Folder folder;
  for (const std::string names : {"lat,lon", "Latitude,Longitude", "LAT [deg],LON [deg]", "x,lat,lon"}) {
    const std::string file =
        folder.write("p.csv", names + (names[0] == 'x' ? "\n7," : "\n") + lat + "," + lon + "\n");
    const Point read = readPath(file, placedMap()).front();
    EXPECT_NEAR(read.x_m, 1300, 1e-5) << names;
    EXPECT_NEAR(read.y_m, 2100, 1e-5) << names;
  }
  const std::string bare = folder.write("bare.csv", "X,Y\n" + lon + "," + lat + "\n");
  EXPECT_THAT([&] { readPath(bare, placedMap()); },
              ThrowsMessage<InputError>(HasSubstr("name them lat and lon")));
}

// Property: the properties x_m, y_m of a route file are read bit for bit, even if its coordinates are
// rounded.
TEST(PathReader, RouteMetresAreReadExactly) {
  EXPECT_THAT(read("r.geojson", R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature",
      "geometry":{"type":"LineString","coordinates":[[0.11,7.02],[0.3,8]]},
      "properties":{"x_m":[0.1,0.30000000000000004],"y_m":[7,8]}}]})"),
              ElementsAre(Point{0.1, 7}, Point{0.30000000000000004, 8}));
}

// Regression: a route edited in another program was checked along its original line.
TEST(PathReader, InconsistentCoordinatesAreRejected) {
  const auto with = [](const std::string& coordinates) {
    return R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature","geometry":{"type":"LineString",
        "coordinates":)" +
           coordinates + R"(},"properties":{"x_m":[1,3],"y_m":[7,8]}}]})";
  };
  EXPECT_THAT(read("r.geojson", with("[[1,7],[3,8]]")), ElementsAre(Point{1, 7}, Point{3, 8}));
  for (const auto& [coordinates, says] :
       {std::pair{"[[1,7],[3,9]]", "vertex 2: its coordinates lie 1 m from"},
        {"[[7,1],[8,3]]", "vertex 1: its coordinates lie"},
        {"[[1,7]]", "has 1 coordinates, but 2 values of x_m"},
        {"[[1,7],[2,7.5],[3,8]]", "has 3 coordinates, but 2"}})
    EXPECT_THAT([&] { read("r.geojson", with(coordinates)); }, ThrowsMessage<InputError>(HasSubstr(says)))
        << coordinates;
}

TEST(PathReader, FirstLineOfAGeoJsonIsRead) {
  EXPECT_THAT(read("l.json", R"({"type":"GeometryCollection","crs":"local","geometries":[
      {"type":"Point","coordinates":[9,9]},{"type":"LineString","coordinates":[[1,2],[3,4]]}]})"),
              ElementsAre(Point{1, 2}, Point{3, 4}));
}

// A path is checked cell by cell, so the total length is limited, although each vertex lies near the map.
TEST(PathReader, PathLongerThanFourMillionCellsIsRejected) {
  std::string rows = "x_m,y_m\n";
  for (int k = 0; k < 100; ++k) rows += k % 2 == 0 ? "0,0\n" : "400000,0\n";
  EXPECT_THAT([&] { read("long.csv", rows); },
              ThrowsMessage<InputError>(HasSubstr("more than 4 million cells")));
}

TEST(PathReader, InvalidPathsAreRejectedWithOneLine) {
  struct Case {
    const char* name;
    const char* content;
    const char* says;
  };
  for (const Case& c :
       {Case{"a.csv", "x_m,z_m\n1,2\n", "names no columns of places"},
        {"n.csv", "lat,lon\n91,2\n", "n.csv:2: must be"},
        {"m.csv", "lat,lon\n1,2\n", "has no CRS for a latitude"},
        {"b.csv", "x_m,y_m\n1,2\n3,inf\n", "b.csv:3"},
        {"c.csv", "x_m,y_m\n", "contains no point"},
        {"d.json", R"({"type":"FeatureCollection","features":[]})", "contains no line"},
        {"e.json", R"({"type":"FeatureCollection","features":[7,{"properties":[]}]})",
         "has a geometry without a \"type\""},
        {"f.json", R"({"type":"LineString"})", "has no list of its positions"},
        {"g.json", R"({"type":"LineString","crs":"local","coordinates":[["a",2]]})", "g.json"},
        {"h.json", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":
            {"x_m":[1,"b"],"y_m":[1,2]},"geometry":null}]})",
         "contains no line"}})
    EXPECT_THAT([&] { read(c.name, c.content); }, ThrowsMessage<InputError>(HasSubstr(c.says))) << c.name;
}

}  // namespace path_reader_test
}  // namespace talus::cli
