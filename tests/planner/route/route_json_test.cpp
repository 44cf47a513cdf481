#include <nlohmann/json.hpp>

#include <talus/planner/route/route_json.hpp>

#include "example_scene.hpp"

namespace talus::planner {
namespace route_json_test {

using cli::exampleMap;
using cli::exampleRoute;

// The fields that the documented interface guarantees.
constexpr const char* kSummary[] = {"status",   "cost",          "energy_J",    "time_s", "length_m",
                                    "max_slip", "max_slope_rad", "lower_bound", "gap",    "planner"};
constexpr const char* kArrays[] = {"x_m",
                                   "y_m",
                                   "elevation_m",
                                   "heading_rad",
                                   "slip",
                                   "sinkage_m",
                                   "slope_along_rad",
                                   "slope_across_rad",
                                   "torque_Nm",
                                   "category",
                                   "drawbar_pull_margin",
                                   "energy_J",
                                   "time_s",
                                   "immobilisation_risk"};

// Property: every documented field exists with one value for each vertex, and the values are restored to the
// bit.
TEST(RouteJson, DocumentedFieldsArePresentWithOneValuePerVertex) {
  const Route route = exampleRoute();
  const auto document = nlohmann::json::parse(
      routeGeoJson(route, exampleMap(), {.files = {{.path = "x/dem.tif", .sha256 = "ba78"}}, .seed = 7})
          .dump());
  const auto& feature = document["features"][0];
  const auto& properties = feature["properties"];
  for (const char* key : kArrays) EXPECT_EQ(properties[key].size(), route.vertices.size()) << key;
  for (const char* key : kSummary) EXPECT_TRUE(properties["summary"].contains(key)) << key;
  EXPECT_EQ(document["crs"], "local");  // the map has none
  EXPECT_EQ(properties["inputs"]["seed"], 7);
  EXPECT_EQ(properties["inputs"]["files"][0]["file"], "dem.tif");
  EXPECT_EQ(properties["inputs"]["files"][0]["sha256"], "ba78");
  EXPECT_EQ(feature["geometry"]["type"], "LineString");
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    EXPECT_EQ(properties["x_m"][i].get<double>(), route.vertices[i].x_m);
    EXPECT_EQ(properties["slip"][i].get<double>(), route.vertices[i].slip);
    EXPECT_EQ(feature["geometry"]["coordinates"][i][1].get<double>(), route.vertices[i].y_m);
  }
  EXPECT_EQ(properties["category"][50], "marginal");
}

// Closed form: RFC 7946 requires two positions in a line, so that a route of zero length repeats its
// position. Unknown values are null, and an unknown elevation is omitted from the position.
TEST(RouteJson, ZeroLengthRouteIsALineAndUnknownValuesAreNull) {
  Route route = exampleRoute();
  route.vertices.resize(1);
  route.vertices[0].elevation_m = route.vertices[0].slip = kNotKnown;
  const auto document = nlohmann::json::parse(routeGeoJson(route, exampleMap(), {}).dump());
  const auto& line = document["features"][0]["geometry"]["coordinates"];
  ASSERT_EQ(line.size(), 2U);
  EXPECT_EQ(line[0], line[1]);
  EXPECT_EQ(line[0].size(), 2U);
  EXPECT_TRUE(document["features"][0]["properties"]["slip"][0].is_null());
}

// Property: fields for controllers exist for drives only.
TEST(RouteJson, DriveFieldsArePresentForDrivesOnly) {
  Route route = exampleRoute();
  EXPECT_FALSE(summaryJson(route).contains("drive"));
  EXPECT_FALSE(routeGeoJson(route, exampleMap(), {})["features"][0]["properties"].contains("reverse"));
  route.drive = RouteShape{.cusps = 2, .turns_in_place = 1};
  EXPECT_EQ(summaryJson(route)["drive"]["cusps"], 2);
  EXPECT_EQ(routeGeoJson(route, exampleMap(), {})["features"][0]["properties"]["reverse"].size(),
            route.vertices.size());
}

}  // namespace route_json_test
}  // namespace talus::planner
