#include <cmath>

#include <nlohmann/json.hpp>

#include <talus/maps/maps_io.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace view_command_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

double hills(int column, int row) {
  return 0.3 * std::sin(column / 5.0) + 0.2 * std::cos(row / 6.0);
}

TEST(ViewCommand, PlannedRouteIsShownOnItsMap) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, hills));
  const Ran plan =
      runTalus({"plan", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido", "--start",
                "3,3", "--goal", "35,30", "-o", "route.geojson", "--html", "plan.html", "--png", "plan.png"},
               folder.path());
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("drawbar-pull margin"));
  EXPECT_THAT(fileContent(folder / "plan.html"), HasSubstr("\"name\":\"allowed headings\""));
  EXPECT_THAT(fileContent(folder / "plan.png"), StartsWith("\x89PNG"));

  const Ran view = runTalus({"view", "route.geojson", "--resolution", "1", "--json"}, folder.path());
  ASSERT_EQ(view.code, 0) << view.err;
  EXPECT_EQ(json::parse(view.out)["html"], "route.html");
  EXPECT_THAT(fileContent(folder / "route.html"), HasSubstr("\"name\":\"slope\""));
  EXPECT_THAT(view.err, Not(HasSubstr("not found")));

  // If the map file is missing, the page shows the route without the map, and a warning is printed.
  std::filesystem::remove(folder.path() / "dem.asc");
  const Ran alone = runTalus({"view", "route.geojson"}, folder.path());
  EXPECT_EQ(alone.code, 0);
  EXPECT_THAT(alone.err, HasSubstr("dem.asc of the route was not found"));
}

// A mission is shown with start, goal, keep-out areas and layers; a picture lies under all.
TEST(ViewCommand, MissionAndPictureAreShown) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, hills));
  maps::writeGeoTiff({.path = folder / "photo.tif"}, "photo",
                     maps::Raster<std::uint8_t>({40, 40, 1.0, {}}, 90), {});
  folder.write("area.json",
               R"({"type":"Polygon","crs":"local","coordinates":[[[9,9],[14,9],[14,14],[9,9]]]})");
  folder.write("m.yaml",
               "maps: {dem: dem.asc, resolution_m: 1, keep_out: area.json}\nrover: fido\n"
               "soil: sandy_loam\nstart: [3, 3]\ngoal: [35, 30]\n");
  const Ran ran =
      runTalus({"view", "m.yaml", "-o", "m.html", "--png", "m.png", "--image", "photo.tif"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  for (const char* part :
       {R"("areas":[{"name":"keep-out")", R"("marks":[{"letter":"S","x":3.0,"y":3.0},{"letter":"G")",
        R"("layers":[{"name":"image")"})
    EXPECT_THAT(fileContent(folder / "m.html"), HasSubstr(part));
  runTalus({"generate", "craters", "--size", "40", "--seed", "1", "-o", "placed.tif", "--quiet"},
           folder.path());
  const Ran placed = runTalus(
      {"plan", "m.yaml", "-o", "r.geojson", "--html", "r.html", "--image", "placed.tif"}, folder.path());
  EXPECT_EQ(placed.code, 2) << placed.out;
  EXPECT_THAT(placed.err, HasSubstr("only one of it and the map has a CRS"));
  EXPECT_FALSE(std::filesystem::exists(folder / "r.geojson"));
}

// The map and the route are in two folders; the program runs in a third.
TEST(ViewCommand, MapIsFoundFromAnotherFolder) {
  const Folder folder;
  for (const char* name : {"maps", "routes", "elsewhere"})
    std::filesystem::create_directory(folder.path() / name);
  folder.write("maps/dem.asc", asciiGrid(40, 40, hills));
  const Ran plan = runTalus({"plan", "maps/dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover",
                             "fido", "--start", "3,3", "--goal", "35,30", "-o", "routes/route.geojson"},
                            folder.path());
  ASSERT_EQ(plan.code, 0) << plan.err;
  const auto route = json::parse(fileContent(folder / "routes/route.geojson"));
  EXPECT_EQ(route["features"][0]["properties"]["inputs"]["files"][0]["path"], "maps/dem.asc");
  for (const char* from : {"elsewhere", "routes", "."}) {
    const Ran view =
        runTalus({"view", folder / "routes/route.geojson", "--resolution", "1", "-o", "page.html"},
                 folder.path() / from);
    EXPECT_EQ(view.code, 0) << view.err;
    EXPECT_THAT(view.err, Not(HasSubstr("was not found"))) << from;
    EXPECT_THAT(fileContent(folder.path() / from / "page.html"), HasSubstr("\"name\":\"slope\"")) << from;
  }
  // A different file at the path of the map is refused.
  folder.write("maps/dem.asc", asciiGrid(40, 40, [](int, int) { return 1.0; }));
  const Ran other =
      runTalus({"view", folder / "routes/route.geojson", "--resolution", "1", "-o", "page.html"},
               folder.path() / "elsewhere");
  EXPECT_EQ(other.code, 0);
  EXPECT_THAT(other.err, HasSubstr("its checksum differs"));
}

// Property: the page of two routes to one goal lists both routes, their differences, and their provenance.
TEST(ViewCommand, RoutesAreCompared) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, hills));
  const std::vector<std::string> call{"plan",    "dem.asc", "--resolution", "1",   "--soil", "sandy_loam",
                                      "--rover", "fido",    "--start",      "3,3", "--goal", "35,30",
                                      "-o"};
  std::vector<std::string> direct = call, detour = call;
  direct.emplace_back("direct.geojson");
  detour.insert(detour.end(), {"<img src=x>.geojson", "--via", "5,30"});
  ASSERT_EQ(runTalus(direct, folder.path()).code, 0);
  ASSERT_EQ(runTalus(detour, folder.path()).code, 0);
  const Ran view = runTalus({"view", "direct.geojson", "<img src=x>.geojson", "--resolution", "1", "--json"},
                            folder.path());
  ASSERT_EQ(view.code, 0) << view.err;
  const auto answer = json::parse(view.out);
  EXPECT_EQ(answer["html"], "direct.html");
  ASSERT_TRUE(answer["comparison"].contains("length"));
  EXPECT_THAT(answer["comparison"]["command"][1].get<std::string>(), HasSubstr("--via 5,30"));
  EXPECT_FALSE(answer["comparison"].contains("rover"));
  EXPECT_THAT(fileContent(folder / "direct.html"), HasSubstr("\"name\":\"\\u003cimg src=x>.geojson\""));

  const Ran map = runTalus({"view", "dem.asc", "direct.geojson", "--resolution", "1"}, folder.path());
  EXPECT_EQ(map.code, 2);
  EXPECT_THAT(map.err, HasSubstr("dem.asc: is not a route file; only routes can be compared"));
  folder.write("far.asc", asciiGrid(2, 2, hills));
  const Ran far = runTalus(
      {"view", "direct.geojson", "direct.geojson", "--map", "far.asc", "--resolution", "1"}, folder.path());
  EXPECT_EQ(far.code, 2);
  EXPECT_THAT(far.err, HasSubstr("does not contain the start of the route direct.geojson"));
}

TEST(ViewCommand, ElevationMapIsShown) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, hills));
  const Ran view =
      runTalus({"view", "dem.asc", "--resolution", "1", "-o", "map.html", "--png", "map.png"}, folder.path());
  ASSERT_EQ(view.code, 0) << view.err;
  EXPECT_THAT(fileContent(folder / "map.html"), HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(fileContent(folder / "map.png"), StartsWith("\x89PNG"));
}

}  // namespace view_command_test
}  // namespace talus::cli
