#include <fstream>

#include <nlohmann/json.hpp>
#include <ogr_geometry.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/vector/vector_reader.hpp>

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

// The names of the features of a document and their geometries in well-known text.
std::vector<std::string> visited(const json& document, const ElevationMap& map) {
  std::vector<std::string> found;
  visitGeoJson(document, map, "p.geojson", [&](const std::string& name, const OGRGeometry* drawn) {
    found.push_back(name + (drawn == nullptr ? "" : drawn->exportToWkt()));
  });
  return found;
}

// The only point of a document.
Point pointOf(const json& document, const ElevationMap& map) {
  Point point;
  visitGeoJson(document, map, "p.geojson", [&](const std::string&, const OGRGeometry* drawn) {
    point = {drawn->toPoint()->getX(), drawn->toPoint()->getY()};
  });
  return point;
}

json pointAt(const json& position) {
  return {{"type", "Point"}, {"coordinates", position}};
}

TEST(GeoJson, GeometriesOfEveryTypeAreVisitedInOrder) {
  const json document = json::parse(R"({"type":"FeatureCollection","crs":"local","features":[
    {"type":"Feature","properties":{"name":"a"},"geometry":{"type":"Point","coordinates":[1,2]}},
    {"type":"Feature","properties":{"name":7},"geometry":null},
    {"type":"Feature","geometry":{"type":"GeometryCollection","geometries":[
      {"type":"MultiPoint","coordinates":[[3,4,9]]},{"type":"LineString","coordinates":[[5,6],[7,8]]}]}},
    {"type":"MultiLineString","coordinates":[[[1,2],[3,4]]]},
    {"type":"MultiPolygon","coordinates":[[[[0,0],[1,0],[0,1],[0,0]]]]}]})");
  EXPECT_THAT(
      visited(document, lunarMap()),
      testing::ElementsAre("aPOINT (1 2)", "", "GEOMETRYCOLLECTION (MULTIPOINT (3 4),LINESTRING (5 6,7 8))",
                           "MULTILINESTRING ((1 2,3 4))", "MULTIPOLYGON (((0 0,1 0,0 1,0 0)))"));
}

// Property: what is no geometry is refused, because a keep-out area would be lost.
TEST(GeoJson, WhatIsNoGeometryIsRejected) {
  for (const char* text : {R"({"coordinates":[1,2]})", R"({"type":7,"coordinates":[1,2]})", "3", R"("x")",
                           R"({"type":"Feature","geometry":{"coordinates":[1,2]}})",
                           R"({"type":"Feature","geometry":{"type":"Polgon","coordinates":[]}})",
                           R"({"type":"Feature","geometry":{"type":"Polygon"}})",
                           R"({"type":"Feature","geometry":{"type":"Polygon","coordinates":[7]}})",
                           R"({"type":"Feature","geometry":{"type":"GeometryCollection","geometries":{}}})"})
    EXPECT_THROW(
        visited({{"type", "FeatureCollection"}, {"features", json::array({json::parse(text)})}}, lunarMap()),
        InputError)
        << text;
  EXPECT_THAT(
      refusal([] { visited(json::parse(R"({"type":"FeatureCollection","features":{}})"), lunarMap()); }),
      HasSubstr("has no list \"features\""));
}

TEST(GeoJson, DegreesAreConvertedByTheMapGeoreference) {
  const ElevationMap map = lunarMap();
  const json position = {0.03, -0.01, 12.0};
  const Point p = pointOf(pointAt(position), map);
  const Point expected = map.georeference->forward({-0.01 * kDegree, 0.03 * kDegree});
  EXPECT_EQ(p, expected);
}

TEST(GeoJson, LocalCoordinatesAreMetresIfDeclaredOrWithoutMapCrs) {
  const ElevationMap map = lunarMap();
  for (
      const char* text :
      {R"({"type":"Point","crs":"local","coordinates":[700,800]})",
       R"({"type":"Feature","properties":{"crs":"local"},"geometry":{"type":"Point","coordinates":[700,800]}})",
       R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"crs":"local"},
            "geometry":{"type":"Point","coordinates":[700,800]}}]})"})
    EXPECT_EQ(pointOf(json::parse(text), map), (Point{700, 800})) << text;
  ElevationMap yard = map;
  yard.georeference.reset();
  EXPECT_EQ(pointOf(pointAt({700.0, 800.0}), yard), (Point{700, 800}));
}

// Property: of the CRS names of GeoJSON 2008, those in degrees are accepted and others rejected; all are
// rejected if the map has no CRS.
TEST(GeoJson, NonDegreeCrsIsRejected) {
  const auto named = [](const std::string& name) {
    return json{{"type", "Point"},
                {"coordinates", {1, 2}},
                {"crs", {{"type", "name"}, {"properties", {{"name", name}}}}}};
  };
  const ElevationMap map = lunarMap();
  ElevationMap yard = map;
  yard.georeference.reset();
  for (const char* name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326"}) {
    EXPECT_NO_THROW(visited(named(name), map)) << name;
    EXPECT_THAT(refusal([&] { visited(named(name), yard); }), HasSubstr("and the map has none"));
  }
  EXPECT_THAT(refusal([&] { visited(named("urn:ogc:def:crs:EPSG::32633"), map); }),
              HasSubstr("not longitude and latitude"));
  const std::string file = testing::TempDir() + "crs.prj";
  std::ofstream(file)
      << R"(GEOGCS["x",DATUM["d",SPHEROID["s",1737400,0]],PRIMEM["p",0],UNIT["degree",0.0174533]])";
  for (const std::string& name : {file, std::string("http://localhost/4326"), std::string()})
    EXPECT_THROW(visited(named(name), map), InputError) << name;
  for (const char* strange : {"7", "[]", "{}", R"({"properties":{"name":3}})"}) {
    const json document{{"type", "Point"}, {"coordinates", {1, 2}}, {"crs", json::parse(strange)}};
    EXPECT_THROW(visited(document, map), InputError) << strange;
    EXPECT_THROW(visited(document, yard), InputError) << strange;
  }
  EXPECT_NO_THROW(visited(json{{"type", "Point"}, {"coordinates", {1, 2}}, {"crs", nullptr}}, yard));
}

TEST(GeoJson, InvalidPositionsAreRejected) {
  const ElevationMap map = lunarMap();
  const auto read = [&](const json& positions) {
    visited({{"type", "MultiPoint"}, {"coordinates", json::array({positions})}}, map);
  };
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
