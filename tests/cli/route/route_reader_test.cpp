#include <cmath>

#include <nlohmann/json.hpp>
#include <ogr_geometry.h>
#include <refused.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/common/common.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/planner/route/route_json.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace route_reader_test {

// Property: calls that differ only in program path, outputs and threads have the same text.
TEST(Provenance, CallTextOmitsOutputsAndThreads) {
  const char* const long_call[] = {"/usr/bin/talus", "plan",          "dem.tif",   "--start", "1,2",    "-o",
                                   "r.geojson",      "--html=p.html", "--threads", "4",       "--seed", "7",
                                   "--json",         "--via",         "it's here", nullptr};
  const char* const short_call[] = {"talus",  "plan", "dem.tif", "--start",   "1,2",
                                    "--seed", "7",    "--via",   "it's here", nullptr};
  EXPECT_EQ(callText(long_call), callText(short_call));
  EXPECT_EQ(callText(short_call), "talus plan dem.tif --start 1,2 --seed 7 --via 'it'\\''s here'");
  EXPECT_EQ(callText(nullptr), "");
}

TEST(Provenance, ProvenanceListsTheInputsOfARoute) {
  const auto inputs = nlohmann::ordered_json::parse(
      R"({"files":[{"file":"dem.tif","path":"x/dem.tif","sha256":"00ff"}],"seed":7,"version":"0.1.0","rover":"mer",
          "soils":["sand","clay"],"command":"talus plan dem.tif"})");
  using Facts = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(provenanceOf(inputs), (Facts{{"command", "talus plan dem.tif"},
                                         {"rover", "mer"},
                                         {"soil", "sand, clay"},
                                         {"seed", "7"},
                                         {"version", "0.1.0"},
                                         {"SHA-256", "dem.tif 00ff"}}));
  EXPECT_TRUE(provenanceOf(nlohmann::ordered_json::array()).empty());
  EXPECT_TRUE(provenanceOf(nlohmann::ordered_json()).empty());
}

using testing::HasSubstr;

/// A route file as JSON.
nlohmann::ordered_json written() {
  return routeGeoJson(exampleRoute(), exampleMap(), {.files = {}, .seed = 7});
}

std::string refusal(const nlohmann::ordered_json& document) {
  const Folder folder;
  try {
    readRoute(folder.write("r.geojson", document.dump()));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(RouteReader, WrittenRouteIsReadExactly) {
  const Folder folder;
  planner::Route route = exampleRoute();
  route.vertices[3].slip = planner::kNotKnown;
  const std::string path =
      folder.write("r.geojson", routeGeoJson(route, exampleMap(), {.files = {}, .seed = 7}).dump());
  EXPECT_TRUE(looksLikeRoute(path));
  const planner::Route back = readRoute(path).route;
  ASSERT_EQ(back.vertices.size(), route.vertices.size());
  EXPECT_TRUE(std::isnan(back.vertices[3].slip));
  for (std::size_t i = 4; i < route.vertices.size(); ++i) {
    EXPECT_EQ(back.vertices[i].x_m, route.vertices[i].x_m);
    EXPECT_EQ(back.vertices[i].slip, route.vertices[i].slip);
    EXPECT_EQ(back.vertices[i].energy_J, route.vertices[i].energy_J);
    EXPECT_EQ(back.vertices[i].category, route.vertices[i].category);
  }
  EXPECT_EQ(back.cost, route.cost);
  EXPECT_EQ(back.planner, route.planner);
}

TEST(RouteReader, ErrorsNameFileAndField) {
  auto document = written();
  auto& properties = document["features"][0]["properties"];
  EXPECT_EQ(refusal(document), "");
  properties["slip"].erase(0);
  EXPECT_THAT(refusal(document), HasSubstr("r.geojson: 'slip' has 60 values for 61 vertices; pass a route"));
  document = written();
  document["features"][0]["geometry"]["coordinates"].erase(0);
  EXPECT_THAT(refusal(document), HasSubstr("'coordinates' are not the 61 of x_m and y_m"));
  document = written();
  auto& east = document["features"][0]["geometry"]["coordinates"][5][0];
  east = east.get<double>() + 2.0;
  EXPECT_THAT(refusal(document), HasSubstr("'coordinates' are not x_m and y_m at vertex 6"));
  document = written();
  document["features"][0]["properties"]["torque_Nm"][7] = 1e300;
  EXPECT_THAT(refusal(document), HasSubstr("'torque_Nm' holds a number beyond 1e30"));
  document = written();
  document["features"][0]["properties"]["category"][5] = "soggy";
  EXPECT_THAT(refusal(document), HasSubstr("'category' contains an unknown word"));
  document = written();
  document["features"][0]["properties"]["x_m"][5] = nullptr;
  EXPECT_THAT(refusal(document), HasSubstr("contain values that are not numbers"));
  document = written();
  document["features"][0]["properties"]["summary"]["cost"] = "much";
  EXPECT_THAT(refusal(document), HasSubstr("'cost' holds what is no number"));
}

TEST(RouteReader, TruncatedRouteIsRejected) {
  // Property: a truncated route file is refused; tested for every 97th length to save time.
  const Folder folder;
  const std::string whole = written().dump();
  EXPECT_REFUSED(readRoute(folder.write("cut.geojson", "")), InputError, "is empty");
  for (std::size_t length = 97; length < whole.size(); length += 97)
    EXPECT_REFUSED(readRoute(folder.write("cut.geojson", whole.substr(0, length))), InputError,
                   "is not valid JSON");
}

TEST(RouteReader, FieldOfWrongTypeIsReadOrRejected) {
  // Property: a property replaced by a text, a number, an empty array or null is read or refused with
  // InputError.
  const Folder folder;
  const auto properties = written()["features"][0]["properties"];
  for (const auto& [key, value] : properties.items()) {
    for (const nlohmann::ordered_json& other : {nlohmann::ordered_json("word"), nlohmann::ordered_json(3.5),
                                                nlohmann::ordered_json::array(), nlohmann::ordered_json()}) {
      auto document = written();
      document["features"][0]["properties"][key] = other;
      try {
        readRoute(folder.write("other.geojson", document.dump()));
      } catch (const InputError&) {
        continue;
      }
    }
  }
}

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

}  // namespace route_reader_test

}  // namespace talus::cli
