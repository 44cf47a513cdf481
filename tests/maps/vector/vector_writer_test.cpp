#include <ogrsf_frmts.h>

#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_writer.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace vector_writer_test {

using testing::HasSubstr;

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

}  // namespace vector_writer_test
}  // namespace talus::maps
