#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/maps/vector/vector_writer.hpp>

#include "layer_fixture.hpp"
#include "raster_fixture.hpp"

namespace talus::maps {
namespace vector_reader_test {

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

// A file of one layer with geometries in WKT.
struct Drawing {
  std::string driver = "GPKG";
  std::string crs = "EPSG:4326";
  std::vector<std::string> wkt{};
};

std::string write(const Drawing& drawing, const std::string& path) {
  registerDrivers();
  const GdalQuiet quiet;
  const GDALDatasetUniquePtr file(
      driverNamed(drawing.driver.c_str()).Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  OGRSpatialReference crs;
  crs.SetFromUserInput(drawing.crs.c_str());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  std::vector<std::unique_ptr<OGRGeometry>> geometries;
  for (const std::string& text : drawing.wkt) {
    OGRGeometry* geometry = nullptr;
    OGRGeometryFactory::createFromWkt(text.c_str(), nullptr, &geometry);
    geometries.emplace_back(geometry);
  }
  const bool gpx = drawing.driver == "GPX";
  const OGRwkbGeometryType type = geometries.front()->getGeometryType();
  OGRLayer* layer = file->CreateLayer(gpx ? (type == wkbPoint ? "waypoints" : "tracks") : "drawn",
                                      drawing.crs.empty() ? nullptr : &crs, type);
  OGRFieldDefn name("name", OFTString);
  if (!gpx) layer->CreateField(&name);
  for (const auto& geometry : geometries) {
    OGRFeature feature(layer->GetLayerDefn());
    feature.SetField("name", "here");
    feature.SetGeometry(geometry.get());
    EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE) << path;
  }
  return path;
}

// Level ground in UTM zone 10 north, 100 x 100 cells of 10 m.
ElevationMap hill(const TemporaryFolder& folder, const std::string& crs = "EPSG:32610") {
  const std::vector<std::vector<double>> rows(100, std::vector<double>(100, 7.0));
  return readElevation(maps::write({.rows = rows, .crs = crs}, folder / "hill.tif"), {.resolution_m = 10.0});
}

// The geometries of a file in well-known text.
std::vector<std::string> drawnIn(const std::string& path, const ElevationMap& map) {
  std::vector<std::string> found;
  visitVector(path, map, [&](const std::string&, const OGRGeometry* drawn) {
    found.push_back(drawn == nullptr ? "" : drawn->exportToWkt());
  });
  return found;
}

const std::map<std::string, std::string> kEndings{
    {"GPKG", "gpkg"}, {"ESRI Shapefile", "shp"}, {"FlatGeobuf", "fgb"}, {"GPX", "gpx"},
    {"KML", "kml"},   {"MapInfo File", "tab"},   {"GeoJSON", "geojson"}};

TEST(VectorReader, EveryVectorFormatYieldsTheSamePlace) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder);
  const GeoPoint place = map.places()->reverse({500300, 4999600});
  std::ostringstream wkt;
  wkt.precision(17);
  wkt << "POINT (" << place.longitude_rad / kDegree << " " << place.latitude_rad / kDegree << ")";
  for (const std::string& driver : vectorFormats()) {
    const std::string path =
        write({.driver = driver, .wkt = {wkt.str()}}, folder / ("place." + kEndings.at(driver)));
    const Point at = readPlace(path, map, "--start");
    // Closed form: the same place. Tolerance: MapInfo stores integer multiples of 1e-6 degrees.
    const double most_m = driver == "MapInfo File" ? 0.1 : 0.01;
    EXPECT_NEAR(at.x_m, 500300, most_m) << driver;
    EXPECT_NEAR(at.y_m, 4999600, most_m) << driver;
  }
}

// Measured by others: PROJ's cs2cs; Bern's old observatory in LV95 is 600000, 200000 in LV03 by definition.
TEST(VectorReader, CoordinatesAreTransformedToTheMapCrs) {
  const TemporaryFolder folder;
  const std::vector<std::vector<double>> rows(100, std::vector<double>(100, 7.0));
  const ElevationMap map = readElevation(maps::write(
      {.rows = rows, .crs = "EPSG:21781", .transform = std::array<double, 6>{599500, 10, 0, 200500, 0, -10}},
      folder / "bern.tif"));
  for (const char* ending : {"gpkg", "geojson"}) {
    const Point at = readPlace(write({.driver = std::string(ending) == "gpkg" ? "GPKG" : "GeoJSON",
                                      .crs = "EPSG:2056",
                                      .wkt = {"POINT (2600000 1200000)"}},
                                     folder / (std::string("bern.") + ending)),
                               map, "--goal");
    EXPECT_NEAR(at.x_m, 600000, 2.0) << ending;
    EXPECT_NEAR(at.y_m, 200000, 2.0) << ending;
  }
}

TEST(VectorReader, KeepOutPolygonsAreReadFromGeoPackage) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder);
  const std::string path = write(
      {.crs = "EPSG:32610",
       .wkt = {"POLYGON ((500000 4999000,500100 4999000,500100 4999100,500000 4999100,500000 4999000))"}},
      folder / "keep.gpkg");
  const KeepOut keep_out = readKeepOut(path, map);
  EXPECT_NE(keep_out.mask[map.grid().cellAt({500050, 4999050}).value()], 0);
  EXPECT_EQ(keep_out.mask[map.grid().cellAt({500150, 4999050}).value()], 0);
  const std::string line = write({.crs = "EPSG:32610", .wkt = {"LINESTRING (500000 4999000,500100 4999000)"}},
                                 folder / "line.gpkg");
  EXPECT_THAT(refusal([&] { readKeepOut(line, map); }), HasSubstr("feature 1 'here': "));
}

TEST(VectorReader, LayersThatCannotBeGeoreferencedAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder), yard = hill(folder, "");
  const auto line = [&](const std::string& path, const ElevationMap& on) {
    return refusal([&] { drawnIn(path, on); });
  };
  const std::string without = write({.crs = "", .wkt = {"POINT (1 1)"}}, folder / "without.gpkg");
  EXPECT_THAT(line(without, map), HasSubstr("without.gpkg: layer 'drawn' has no CRS, and the map has one"));
  EXPECT_EQ(line(without, yard), "accepted");
  const std::string mars = write({.crs = "IAU_2015:49900", .wkt = {"POINT (137 -4)"}}, folder / "mars.gpkg");
  EXPECT_THAT(line(mars, map), HasSubstr("of Mars, and the map is of Earth"));
  EXPECT_THAT(line(mars, yard), HasSubstr("and the map has no CRS"));
  const ElevationMap gale = hill(folder, "IAU_2015:49910");
  EXPECT_THAT(line(write({.driver = "GPX", .wkt = {"POINT (137 -4)"}}, folder / "p.gpx"), gale),
              HasSubstr("of Earth, and the map is of Mars; draw it in the CRS of the map; GPX and KML"));
  const std::string moon = R"({"type":"Point","coordinates":[1,2],"crs":"IAU_2015:30100"})";
  EXPECT_THAT(refusal([&] { readPlace(folder.write("moon.geojson", moon), map, "--goal"); }),
              HasSubstr("of Moon, and the map is of Earth"));
  EXPECT_THAT(line(folder.write("text.gpkg", "no vector file"), map), HasSubstr("GDAL opens no vector file"));
  EXPECT_THAT(line(folder / "none.gpkg", map), HasSubstr("no such file"));
  EXPECT_THAT(
      line(folder.write("empty.kml", R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2">)"
                                     "<Document></Document></kml>"),
           map),
      HasSubstr("empty.kml"));
  EXPECT_THAT(line(folder.write("none.gpx", R"(<?xml version="1.0"?><gpx version="1.1"></gpx>)"), map),
              HasSubstr("contains no feature"));
}

// Property: a file truncated anywhere is rejected, or contains only geometries of the whole file.
TEST(VectorReader, TruncatedFileIsRejectedOrComplete) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder);
  for (const std::string& driver : vectorFormats()) {
    const std::string path =
        write({.driver = driver, .wkt = {"POINT (-123 45.1)", "POINT (-122.9 45.1)", "POINT (-122.8 45.2)"}},
              folder / ("whole." + kEndings.at(driver)));
    const std::vector<std::string> whole = drawnIn(path, map);
    EXPECT_EQ(whole.size(), 3U) << driver;
    const auto size = std::filesystem::file_size(path);
    for (int part = 1; part < 40; ++part) {
      std::filesystem::resize_file(path, size - size * static_cast<std::uintmax_t>(part) / 40);
      const std::string line = refusal([&] { EXPECT_EQ(drawnIn(path, map), whole); });
      EXPECT_THAT(line, testing::AnyOf("accepted", HasSubstr("whole."))) << driver;
    }
  }
}

// Property: geometries of a GeoPackage with holes, parts and collections cover the same cells as in GeoJSON.
TEST(VectorReader, KeepOutAreasAreTheSameInEveryForm) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder);
  const std::string ring = "(500105 4999105,500405 4999155,500355 4999455,500105 4999105)",
                    hole = "(500205 4999185,500305 4999205,500285 4999285,500205 4999185)",
                    other = "(500605 4999605,500705 4999605,500655 4999705,500605 4999605)";
  for (const std::string& wkt :
       {"POLYGON (" + ring + "," + hole + ")", "MULTIPOLYGON ((" + ring + "," + hole + "),(" + other + "))",
        "GEOMETRYCOLLECTION (POLYGON (" + ring + "),POLYGON (" + other + "))"}) {
    OGRGeometry* made = nullptr;
    OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &made);
    const std::unique_ptr<OGRGeometry> geometry(made);
    const std::unique_ptr<char, decltype(&CPLFree)> text(geometry->exportToJson(), CPLFree);
    const std::string file = folder.write(
        "keep.geojson",
        R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature","geometry":)" +
            std::string(text.get()) + "}]}");
    const KeepOut as_json = readKeepOut(file, map);
    std::filesystem::remove(folder / "keep.gpkg");
    EXPECT_EQ(
        readKeepOut(write({.crs = "EPSG:32610", .wkt = {wkt}}, folder / "keep.gpkg"), map).mask.values(),
        as_json.mask.values())
        << wkt;
    EXPECT_GT(std::ranges::count(as_json.mask.values(), 1), 100) << wkt;
  }
}

TEST(VectorReader, RefusesMorePositionsThanAPathOrTheMemoryHas) {
  const TemporaryFolder folder;
  const ElevationMap map = hill(folder);
  std::ostringstream wkt;
  wkt << "LINESTRING (0 0";
  for (int i = 1; i <= 1'000'000; ++i) wkt << "," << i % 90 << " 1";
  wkt << ")";
  const std::string path = write({.wkt = {wkt.str()}}, folder / "long.gpkg");
  EXPECT_THAT(refusal([&] { readLine(path, map); }),
              HasSubstr("contains 1000001 positions, more than a million; simplify its lines"));
  setMemoryBudget(100'000'000);
  EXPECT_THAT(refusal([&] { readKeepOut(path, map); }), HasSubstr("more than the memory budget"));
  setMemoryBudget(0);
}

using nlohmann::json;

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

ElevationMap mapOf(const Ellipsoid& body, double longitude_deg) {
  ElevationMap map;
  map.elevation_m = Raster<float>(Grid{.width = 2, .height = 2, .resolution_m = 10.0});
  map.georeference.emplace(CoordinateSystem{.name = "site",
                                            .ellipsoid = body,
                                            .projection = {.method = ProjectionMethod::TransverseMercator,
                                                           .central_meridian_rad = longitude_deg * kDegree}});
  return map;
}

const std::vector<VectorLayer> kLayers{
    {"line",
     {{{{{1.0, 2.0}, 5.0}, {{3.0, 4.5}, kNaN}},
       {{"name", "way"}, {"count", 3}, {"share", 0.1}, {"none", kNaN}, {"open", true}, {"desc", "a"}}}}},
    {"points", {{{{{1.0, 2.0}, 5.0}}, {{"slip", 0.25}}}, {{{{3.0, 4.5}, 6.0}}, {{"slip", nullptr}}}}}};

Dataset opened(const TemporaryFolder& folder, const std::string& name, const std::string& bytes) {
  return openVector(folder.write(name, bytes));
}

TEST(VectorWriter, GeoPackageHasTheMapCrsAndFields) {
  const TemporaryFolder folder;
  const ElevationMap map = mapOf(kMars, 137.0);
  const std::string bytes = vectorFile("GPKG", map, kLayers, "r.gpkg", "{}");
  EXPECT_EQ(vectorFile("GPKG", map, kLayers, "r.gpkg", "{}"), bytes) << "same layers, same bytes";
  const Dataset file = opened(folder, "r.gpkg", bytes);
  ASSERT_EQ(file->GetLayerCount(), 2);
  OGRLayer& line = *file->GetLayer(0);
  EXPECT_NEAR(line.GetSpatialRef()->GetSemiMajor(), kMars.equatorial_radius_m, 1e-3);
  EXPECT_NEAR(line.GetSpatialRef()->GetInvFlattening(), 1.0 / kMars.flattening, 1e-6);
  const OGRFeatureUniquePtr way(line.GetNextFeature());
  EXPECT_STREQ(way->GetFieldAsString("name"), "way");
  EXPECT_EQ(way->GetFieldAsInteger("count"), 3);
  EXPECT_EQ(way->GetFieldAsDouble("share"), 0.1);
  EXPECT_EQ(way->GetFieldAsInteger("open"), 1);
  EXPECT_FALSE(way->IsFieldSetAndNotNull(way->GetFieldIndex("none")));
  const OGRLineString& drawn = *way->GetGeometryRef()->toLineString();
  EXPECT_EQ(drawn.getX(1), 3.0);
  EXPECT_EQ(drawn.getY(1), 4.5);
  EXPECT_EQ(drawn.getZ(0), 5.0);
  EXPECT_EQ(file->GetLayerByName("points")->GetFeatureCount(), 2);
  const StoredDocument stored = storedDocument(folder / "r.gpkg");
  EXPECT_EQ(stored.document, "{}");
  EXPECT_EQ(stored.line, (std::vector<Point>{{1.0, 2.0}, {3.0, 4.5}}));
}

TEST(VectorWriter, GpxAndKmlCoordinatesAreWgs84) {
  const TemporaryFolder folder;
  const ElevationMap map = mapOf(kEarth, 7.0);
  const GeoPoint place = map.places()->reverse({3.0, 4.5});
  for (const auto& [driver, name] : {std::pair{"GPX", "r.gpx"}, {"KML", "r.kml"}}) {
    const std::vector<VectorLayer> line{kLayers[0]};
    const Dataset file = opened(folder, name, vectorFile(driver, map, line, name));
    bool seen = false;
    for (OGRLayer* layer : file->GetLayers())
      for (const auto& feature : *layer) {
        const OGRGeometry& drawn = *feature->GetGeometryRef();
        const auto type = wkbFlatten(drawn.getGeometryType());
        const OGRLineString* way = type == wkbLineString        ? drawn.toLineString()
                                   : type == wkbMultiLineString ? drawn.toMultiLineString()->getGeometryRef(0)
                                                                : nullptr;
        if (way == nullptr) continue;
        seen = true;
        EXPECT_STREQ(feature->GetFieldAsString("name"), "way") << driver;
        // Tolerance: GPX has nine decimals.
        EXPECT_NEAR(way->getX(1), place.longitude_rad / kDegree, 1e-9) << driver;
        EXPECT_NEAR(way->getY(1), place.latitude_rad / kDegree, 1e-9) << driver;
      }
    EXPECT_TRUE(seen) << driver;
  }
}

TEST(VectorWriter, GpxAndKmlRequireAnEarthMap) {
  ElevationMap local = mapOf(kEarth, 0.0);
  local.georeference.reset();
  for (const char* driver : {"GPX", "KML"}) {
    EXPECT_THAT(
        refusal([&] { vectorFile(driver, mapOf(kMoon, 0.0), kLayers, "r", ""); }),
        HasSubstr("r: " + std::string(driver) +
                  " has places of Earth in WGS 84 alone, and the map is of Moon; write a GeoPackage"));
    EXPECT_THAT(refusal([&] { vectorFile(driver, local, kLayers, "r", ""); }),
                HasSubstr("and the map has no CRS"));
  }
  EXPECT_EQ(refusal([&] { vectorFile("GPKG", local, kLayers, "r", ""); }), "accepted");
}

TEST(VectorWriter, ForeignGeoPackageHasNoStoredDocument) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("own.gpkg", vectorFile("GPKG", mapOf(kMoon, 0.0), kLayers, "own.gpkg"));
  EXPECT_THAT(refusal([&] { storedDocument(path); }), HasSubstr("contains no route of talus plan"));
}

}  // namespace vector_reader_test
}  // namespace talus::maps
