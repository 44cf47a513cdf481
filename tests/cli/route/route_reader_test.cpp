#include <cmath>

#include <nlohmann/json.hpp>
#include <refused.hpp>

#include <talus/cli/route/route_reader.hpp>
#include <talus/common/input_error.hpp>
#include <talus/planner/route/route_json.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace route_reader_test {

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

}  // namespace route_reader_test
}  // namespace talus::cli
