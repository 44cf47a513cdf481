#include <algorithm>
#include <map>
#include <sstream>

#include <ogrsf_frmts.h>

#include <talus/common/constants.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/layer_reader.hpp>
#include <talus/maps/vector/place_reader.hpp>
#include <talus/maps/vector/vector_reader.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace vector_reader_test {

using testing::HasSubstr;

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

}  // namespace vector_reader_test
}  // namespace talus::maps
