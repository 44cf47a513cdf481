#include <nlohmann/json.hpp>
#include <ogr_geometry.h>
#include <refused.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/path_reader.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/vector/vector_reader.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace route_writer_test {

using testing::HasSubstr;

maps::ElevationMap mapOf(const maps::Ellipsoid& body) {
  maps::ElevationMap map = exampleMap();
  map.georeference.emplace(maps::CoordinateSystem{.name = "site", .ellipsoid = body});
  return map;
}

std::string write(const Folder& folder, const std::string& name, const maps::ElevationMap& map) {
  Context context;
  planner::writeRoute(folder / name, routeGeoJson(exampleRoute(), map, {.files = {}, .seed = 7}), map,
                      [&](std::string_view line) { context.warn(line); });
  return folder / name;
}

// Property: every format gives the same metres when `talus score --path` reads the file, except for rounded
// degrees.
TEST(RouteWriter, EveryFormatRoundTripsAsAPath) {
  const Folder folder;
  const maps::ElevationMap map = mapOf(maps::kEarth);
  const planner::Route route = exampleRoute();
  for (const auto& [name, most_m] :
       {std::pair{"r.geojson", 0.0}, {"r.gpkg", 0.0}, {"r.csv", 0.0}, {"r.gpx", 2e-3}, {"r.kml", 1e-6}}) {
    const auto points = readPath(write(folder, name, map), map);
    ASSERT_EQ(points.size(), route.vertices.size()) << name;
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LE(std::hypot(points[i].x_m - route.vertices[i].x_m, points[i].y_m - route.vertices[i].y_m),
                most_m)
          << name;
  }
}

TEST(RouteWriter, GeoPackageRoundTripsAsARoute) {
  const Folder folder;
  const planner::Route route = exampleRoute();
  const std::string path = write(folder, "r.gpkg", mapOf(maps::kMoon));
  ASSERT_TRUE(looksLikeRoute(path));
  const RouteFile back = readRoute(path);
  ASSERT_EQ(back.route.vertices.size(), route.vertices.size());
  EXPECT_EQ(back.route.vertices[5].slip, route.vertices[5].slip);
  EXPECT_EQ(back.route.energy_J, route.energy_J);
  std::map<std::string, int> types;
  maps::visitVector(path, mapOf(maps::kMoon), [&](const std::string&, const OGRGeometry* drawn) {
    if (drawn != nullptr) ++types[OGRToOGCGeomType(drawn->getGeometryType())];
  });
  const int vertices = static_cast<int>(route.vertices.size());
  EXPECT_THAT(fileContent(path), HasSubstr("attr=\"category\" symbollevels"));  // the style for QGIS
  EXPECT_EQ(types, (std::map<std::string, int>{{"LINESTRING", vertices}, {"POINT", vertices}}));
}

TEST(RouteWriter, FormatsWithoutBodyWarnOrReject) {
  const Folder folder;
  testing::internal::CaptureStderr();
  write(folder, "r.geojson", mapOf(maps::kMars));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("GeoJSON does not say that its longitudes and latitudes are of Mars"));
  testing::internal::CaptureStderr();
  write(folder, "r.gpkg", mapOf(maps::kMars));
  write(folder, "e.geojson", mapOf(maps::kEarth));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  write(folder, "l.geojson", exampleMap());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("l.gpkg, or give the map a CRS"));
  EXPECT_REFUSED(write(folder, "r.gpx", mapOf(maps::kMars)), InputError,
                 "has places of Earth in WGS 84 alone");
  EXPECT_EQ(fileContent(folder / "r.gpx"), "");
}

TEST(RouteWriter, TableHasARowForEachVertex) {
  const Folder folder;
  const std::string table = fileContent(write(folder, "r.csv", mapOf(maps::kMoon)));
  EXPECT_TRUE(table.starts_with("x_m,y_m,")) << table.substr(0, 80);
  EXPECT_THAT(table.substr(0, table.find('\n')), testing::EndsWith(",latitude_deg,longitude_deg"));
  EXPECT_EQ(std::ranges::count(table, '\n'), static_cast<std::ptrdiff_t>(exampleRoute().vertices.size()) + 1);
  const std::string local = fileContent(write(folder, "l.csv", exampleMap()));
  EXPECT_THAT(local.substr(0, local.find('\n')), testing::Not(testing::EndsWith(",")));
}

}  // namespace route_writer_test
}  // namespace talus::cli
