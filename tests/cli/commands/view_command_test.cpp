#include <cmath>

#include <nlohmann/json.hpp>

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

TEST(ViewCommand, ShowsTheRouteThatPlanWroteOnItsMap) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, hills));
  const Ran plan =
      runTalus({"plan", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido", "--start",
                "3,3", "--goal", "35,30", "-o", "route.geojson", "--html", "plan.html", "--png", "plan.png"},
               folder.path());
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("drawbar-pull margin"));
  EXPECT_THAT(fileContent(folder / "plan.html"), HasSubstr("\"name\":\"categories\""));
  EXPECT_THAT(fileContent(folder / "plan.png"), StartsWith("\x89PNG"));

  const Ran view = runTalus({"view", "route.geojson", "--resolution", "1", "--json"}, folder.path());
  ASSERT_EQ(view.code, 0) << view.err;
  EXPECT_EQ(json::parse(view.out)["html"], "route.html");
  EXPECT_THAT(fileContent(folder / "route.html"), HasSubstr("\"name\":\"slope\""));
  EXPECT_THAT(view.err, Not(HasSubstr("not found")));

  // The map is gone: the route alone, and it is said.
  std::filesystem::remove(folder.path() / "dem.asc");
  const Ran alone = runTalus({"view", "route.geojson"}, folder.path());
  EXPECT_EQ(alone.code, 0);
  EXPECT_THAT(alone.err, HasSubstr("dem.asc of the route was not found"));
}

// The map in a folder of its own, the route in another, the call from a third.
TEST(ViewCommand, FindsTheMapFromAnotherFolder) {
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
  // Another file at that place is not the map.
  folder.write("maps/dem.asc", asciiGrid(40, 40, [](int, int) { return 1.0; }));
  const Ran other =
      runTalus({"view", folder / "routes/route.geojson", "--resolution", "1", "-o", "page.html"},
               folder.path() / "elsewhere");
  EXPECT_EQ(other.code, 0);
  EXPECT_THAT(other.err, HasSubstr("its checksum differs"));
}

TEST(ViewCommand, ShowsAnElevationMap) {
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
