#include <algorithm>
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include <talus/cli/app/texts.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace init_command_test {

using testing::HasSubstr;

TEST(InitCommand, CreatedMissionCanBePlanned) {
  const Folder folder;
  folder.write("flat ground.asc", asciiGrid(20, 20, [](int column, int) { return 0.01 * column; }));
  std::filesystem::create_directory(folder / "m");
  const Ran made =
      runTalus({"init", "flat ground.asc", "--resolution", "1", "-o", "m/site.yaml"}, folder.path());
  ASSERT_EQ(made.code, 0) << made.err;
  const Ran planned = runTalus({"plan", "m/site.yaml", "--quiet"}, folder.path());
  EXPECT_EQ(planned.code, 0) << planned.err;
  EXPECT_THAT(fileContent(folder / "m/site_route.geojson"), HasSubstr("\"FeatureCollection\""));
  const Ran again =
      runTalus({"init", "flat ground.asc", "--resolution", "1", "-o", "m/site.yaml"}, folder.path());
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("m/site.yaml: exists; name another file with -o, or pass --force"));
}

// Property: a created mission has a feasible route on level ground, and also where the preferred start and
// goal are blocked or enclosed by walls.
TEST(InitCommand, ItsPlacesAreJoined) {
  const Folder folder;
  const auto walled = [](int column, int row) {
    const auto near = [&](int c, int r) { return std::max(std::abs(column - c), std::abs(row - r)); };
    return near(10, 10) == 4 || near(30, 30) == 4 || near(30, 30) < 2 ? 3.0 : 0.0;
  };
  folder.write("walled.asc", asciiGrid(40, 40, walled));
  folder.write("level.asc", asciiGrid(20, 20, [](int, int) { return 0.0; }));
  for (const std::string name : {"walled", "level"}) {
    const Ran made =
        runTalus({"init", name + ".asc", "--resolution", "1", "-o", name + ".yaml"}, folder.path());
    ASSERT_EQ(made.code, 0) << made.err;
    const Ran planned = runTalus({"plan", name + ".yaml", "--quiet"}, folder.path());
    EXPECT_EQ(planned.code, 0) << name << planned.out << planned.err;
  }
}

// Property: a mission of a generated site names its classes, soils and rocks, so that `talus plan` reads them.
TEST(InitCommand, LayersBesideTheMapAreTaken) {
  const Folder folder;
  ASSERT_EQ(runTalus({"generate", "dunes", "--size", "40", "-o", "site.tif"}, folder.path()).code, 0);
  const Ran made = runTalus({"init", "site.tif"}, folder.path());
  EXPECT_THAT(made.out, HasSubstr("layers      site_classes.tif, site_soils.yaml, site_rocks.tif\n"));
  EXPECT_THAT(
      fileContent(folder / "mission.yaml"),
      testing::AllOf(HasSubstr("terrain: \"site_classes.tif\""), HasSubstr("rocks: \"site_rocks.tif\""),
                     HasSubstr("\nsoils: \"site_soils.yaml\"")));
  std::filesystem::remove(folder / "site_soils.yaml");
  EXPECT_THAT(runTalus({"init", "site.tif", "-o", "m.yaml"}, folder.path()).err,
              HasSubstr("site_classes.tif is not taken: site_soils.yaml is missing"));
}

// Property: a created mission file contains every key that the reader accepts.
TEST(InitCommand, CreatedMissionHasEveryKey) {
  const std::string text = runTalus({"help", "missions"}).out;
  for (const auto keys : {keysOf("Mission"), keysOf("Mission: maps"), keysOf("Mission: thresholds")})
    for (const terramech::FileKey& key : keys)
      EXPECT_THAT(text, HasSubstr(std::string(key.name) + ":")) << key.name;
}

}  // namespace init_command_test
}  // namespace talus::cli
