#include <fstream>

#include <nlohmann/json.hpp>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/vector/geojson.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace geojson_test {

using nlohmann::json;
using testing::HasSubstr;

ElevationMap lunarMap() {
  ElevationMap map{.elevation_m = Raster<float>(Grid{.width = 10, .height = 10}),
                   .georeference = std::nullopt,
                   .source = "moon.tif",
                   .notes = {}};
  map.georeference.emplace(CoordinateSystem{.name = "Moon", .ellipsoid = kMoon});
  return map;
}

TEST(GeoJson, GeometriesOfAnyNestingAreFoundInOrder) {
  const json document = json::parse(R"({"type":"FeatureCollection","features":[
    {"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}},
    {"type":"Feature","geometry":null},
    {"type":"Feature","geometry":{"type":"GeometryCollection","geometries":[
      {"type":"Point","coordinates":[3,4]},{"type":"LineString","coordinates":[[5,6],[7,8]]}]}}]})");
  const auto found = geometries(document);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].get()["coordinates"], json({1, 2}));
  EXPECT_EQ(found[1].get()["coordinates"], json({3, 4}));
  EXPECT_EQ(found[2].get()["type"], "LineString");
}

// Property: an object without a type, or with a type that is not text, is no geometry.
TEST(GeoJson, ObjectsWithoutTypeAreNoGeometry) {
  EXPECT_TRUE(geometries(json::parse(R"({"type":"FeatureCollection","features":[{"coordinates":[1,2]},
    {"type":7,"coordinates":[1,2]}, 3, null, "x"]})"))
                  .empty());
  EXPECT_TRUE(geometries(json::parse(R"({"type":"Feature","geometry":{"coordinates":[1,2]}})")).empty());
  EXPECT_TRUE(geometries(json::parse(R"({"type":"FeatureCollection","features":{}})")).empty());
}

TEST(GeoJson, DegreesAreConvertedByTheMapGeoreference) {
  const ElevationMap map = lunarMap();
  const json position = {0.03, -0.01, 12.0};
  const Point p = PositionReader(json{{"type", "Point"}}, map, "p.geojson")(position);
  const Point expected = map.georeference->forward({-0.01 * kDegree, 0.03 * kDegree});
  EXPECT_EQ(p, expected);
}

TEST(GeoJson, LocalCoordinatesAreMetresIfDeclaredOrWithoutMapCrs) {
  const ElevationMap map = lunarMap();
  for (const char* text :
       {R"({"type":"Point","crs":"local"})", R"({"type":"Feature","properties":{"crs":"local"}})",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"crs":"local"}}]})"})
    EXPECT_EQ(PositionReader(json::parse(text), map, "")(json{700.0, 800.0}), (Point{700, 800})) << text;
  ElevationMap yard = map;
  yard.georeference.reset();
  EXPECT_EQ(PositionReader(json{{"type", "Point"}}, yard, "")(json{700.0, 800.0}), (Point{700, 800}));
}

// Property: of the CRS names of GeoJSON 2008, those in degrees are accepted and others rejected; all are
// rejected if the map has no CRS.
TEST(GeoJson, NonDegreeCrsIsRejected) {
  const auto named = [](const std::string& name) {
    return json{{"type", "Point"}, {"crs", {{"type", "name"}, {"properties", {{"name", name}}}}}};
  };
  const ElevationMap map = lunarMap();
  ElevationMap yard = map;
  yard.georeference.reset();
  for (const char* name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326"}) {
    EXPECT_NO_THROW(PositionReader(named(name), map, "p.geojson")) << name;
    EXPECT_THAT(refusal([&] { PositionReader(named(name), yard, "p.geojson"); }),
                HasSubstr("and the map has none"));
  }
  EXPECT_THAT(refusal([&] { PositionReader(named("urn:ogc:def:crs:EPSG::32633"), map, "p.geojson"); }),
              HasSubstr("not longitude and latitude"));
  const std::string file = testing::TempDir() + "crs.prj";
  std::ofstream(file)
      << R"(GEOGCS["x",DATUM["d",SPHEROID["s",1737400,0]],PRIMEM["p",0],UNIT["degree",0.0174533]])";
  for (const std::string& name : {file, std::string("http://localhost/4326"), std::string()})
    EXPECT_THROW(PositionReader(named(name), map, "p.geojson"), InputError) << name;
  for (const char* strange : {"7", "[]", "{}", R"({"properties":{"name":3}})"}) {
    const json document{{"type", "Point"}, {"crs", json::parse(strange)}};
    EXPECT_THROW(PositionReader(document, map, "p.geojson"), InputError) << strange;
    EXPECT_THROW(PositionReader(document, yard, "p.geojson"), InputError) << strange;
  }
  EXPECT_NO_THROW(PositionReader(json{{"type", "Point"}, {"crs", nullptr}}, yard, "p.geojson"));
}

TEST(GeoJson, InvalidPositionsAreRejected) {
  const ElevationMap map = lunarMap();
  const PositionReader read(json{{"type", "Point"}}, map, "p.geojson");
  for (const char* text : {"7", "[]", "[1]", R"(["1",2])", "[1,null]", "{}", "null"})
    EXPECT_THAT(refusal([&] { read(json::parse(text)); }),
                HasSubstr("p.geojson: a position is not an array of numbers"))
        << text;
  EXPECT_THAT(refusal([&] { read(json{0, 90.1}); }), HasSubstr("[0,90.1] is not a longitude and latitude"));
  EXPECT_THAT(refusal([&] { read(json{361, 0}); }), HasSubstr("is not a longitude and latitude"));
}

TEST(GeoJson, InvalidGeoJsonIsRejected) {
  const TemporaryFolder folder;
  const auto line = [&](const std::string& content) {
    return refusal([&] { readGeoJson(folder.write("a.json", content)); });
  };
  EXPECT_THAT(line(R"({"type":"Point",)"), HasSubstr("is not JSON"));
  EXPECT_THAT(line("7"), HasSubstr("is not GeoJSON"));
  EXPECT_THAT(line(R"({"type":7})"), HasSubstr("is not GeoJSON"));
  EXPECT_EQ(line(R"({"type":"Point","coordinates":[1,2]})"), "accepted");
  std::string deep = R"({"type":"Point","coordinates":)";
  deep += std::string(100000, '[') + std::string(100000, ']') + "}";
  EXPECT_THAT(line(deep), HasSubstr("nests deeper than 100 levels"));
  // Duplicate keys of one object are rejected, because the last would replace the first; equal keys in
  // different objects are valid.
  EXPECT_THAT(line(R"({"type":"Point","coordinates":[1,2],"coordinates":[3,4]})"),
              HasSubstr("has \"coordinates\" twice in one object"));
  EXPECT_THAT(
      line(R"({"type":"FeatureCollection","features":[{"type":"Feature"},{"a":{},"type":"x","a":1}]})"),
      HasSubstr("has \"a\" twice"));
  EXPECT_EQ(line(R"({"type":"FeatureCollection","features":[{"type":"a"},{"type":"b","p":{"type":"c"}}]})"),
            "accepted");
}

// Property: large files are rejected before parsing, because the parsed tree needs many times the memory of
// the text.
TEST(GeoJson, MemoryBudgetIsCheckedBeforeParsing) {
  const TemporaryFolder folder;
  std::string text = R"({"type":"Polygon","coordinates":[[])";
  while (text.size() < 5'000'000) text += ",[]";
  const std::string path = folder.write("big.json", text + "]}");
  setMemoryBudget(150'000'000);
  EXPECT_THAT(refusal([&] { readGeoJson(path); }), HasSubstr("needs 0.16 GB, more than the memory budget"));
  setMemoryBudget(0);
}

}  // namespace geojson_test
}  // namespace talus::maps
