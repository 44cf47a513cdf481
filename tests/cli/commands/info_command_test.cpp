#include <algorithm>

#include <nlohmann/json.hpp>
#include <octomap/OcTree.h>

#include "run_program.hpp"

namespace talus::cli {
namespace info_command_test {

using testing::HasSubstr;

// A plane that rises by 1 m in 4 m to the north-east, as an ASCII grid without a coordinate reference system.
std::string plane(const Folder& folder) {
  std::string text = "ncols 6\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 2\nnodata_value -9999\n";
  for (int row = 4; row >= 0; --row) {
    for (int column = 0; column < 6; ++column) text += std::to_string(0.5 * column) + " ";
    text += "\n";
  }
  return folder.write("plane.asc", text);
}

TEST(InfoCommand, JsonHasTheDocumentedFields) {
  const Folder folder;
  const Ran ran = runTalus({"--json", "info", plane(folder), "--resolution", "2"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["width"], 6);
  EXPECT_EQ(json["height"], 5);
  EXPECT_EQ(json["resolution_m"], 2.0);
  EXPECT_EQ(json["crs"], "local");
  EXPECT_TRUE(json["body"].is_null());
  EXPECT_EQ(json["valid_fraction"], 1.0);
  // Closed form: slope atan(1 / 4).
  for (const char* quantile : {"p50", "p90", "p99"})
    EXPECT_NEAR(json["slope_deg"][quantile].get<double>(), 14.0362, 1e-3);
  EXPECT_THAT(ran.err, HasSubstr("warning"));
  EXPECT_EQ(runTalus({"--json", "--quiet", "info", folder / "plane.asc", "--resolution", "2"}).err, "");
}

// Property: every DEM argument also accepts a point cloud.
TEST(InfoCommand, PointCloudIsAcceptedAsAMap) {
  const Folder folder;
  octomap::OcTree tree(0.5);
  for (int column = 0; column < 24; ++column)
    for (int row = 0; row < 20; ++row)
      tree.updateNode(octomap::point3d(0.25F + 0.5F * static_cast<float>(column),
                                       0.25F + 0.5F * static_cast<float>(row), 0.25F),
                      true);
  tree.writeBinary(folder / "cloud.bt");
  const Ran info = runTalus({"--json", "info", "cloud.bt"}, folder.path());
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["width"], 24);
  EXPECT_EQ(nlohmann::json::parse(info.out)["slope_deg"]["p99"], 0.0);
  const Ran plan = runTalus({"--json", "plan", "cloud.bt", "--rover", "sojourner", "--soil", "sandy_loam",
                             "--start", "2,2", "--goal", "9,8"},
                            folder.path());
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_EQ(runTalus({"view", "cloud.bt"}, folder.path()).code, 0);
  EXPECT_THAT(runTalus({"info", "cloud.bt", "--resolution", "1"}, folder.path()).err,
              HasSubstr("has a grid of its own"));
}

TEST(InfoCommand, ErrorsAreOneLineWithCodeTwo) {
  const Folder folder;
  const std::string map = plane(folder);
  struct Case {
    std::vector<std::string> words;
    const char* says;
  };
  const std::vector<Case> cases{
      {{"info"}, "DEM is required"},
      {{"info", folder / "none.tif"}, "no such file"},
      {{"info", folder.path().string()}, "is a directory"},
      {{"info", folder.write("text.tif", "no raster")}, "GDAL opens no raster"},
      {{"info", map}, "no CRS; pass --resolution METRES"},
      {{"info", map, "--resolution", "0"}, "--resolution: must be 0.001 to 1000000 metres"},
      {{"info", map, "--resolution", "x"}, "--resolution"},
      {{"info", map, "--resolution", "2", "--band", "3"}, "no such band"},
      {{"info", map, "--resolution", "2", "--window", "1,2,3"}, "has not 4 numbers"},
      {{"info", map, "--resolution", "2", "--window", "90,90,99,99"}, "outside the map"},
      {{"info", map, "--resolution", "2", "--max-cells", "5"}, "too many"},
      {{"info", map, "--resolution", "2", "--footprint", "-1"}, "radius_m"},
  };
  for (const Case& c : cases) {
    const Ran ran = runTalus(c.words);
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_THAT(ran.err, HasSubstr(c.says));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'),
              1 + static_cast<long>(ran.err.find("warning") != std::string::npos))
        << ran.err;
  }
}

}  // namespace info_command_test
}  // namespace talus::cli
