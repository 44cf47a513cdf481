#include <nlohmann/json.hpp>
#include <octomap/OcTree.h>

#include "bad_input.hpp"

namespace talus::cli {
namespace info_command_test {

using testing::HasSubstr;

// Closed form: a plane that rises by 1 m in 4 m has the slope atan(1 / 4).
TEST(InfoCommand, SlopeOfAPlaneMatchesClosedForm) {
  const Folder folder;
  folder.write("plane.asc", asciiGrid(6, 5, [](int column, int) { return 0.25 * column; }));
  const Ran ran = runTalus({"--json", "info", "plane.asc", "--resolution", "1"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["crs"], "local");
  EXPECT_TRUE(json["body"].is_null());
  EXPECT_EQ(json["valid_fraction"], 1.0);
  for (const char* quantile : {"p50", "p90", "p99"})
    EXPECT_NEAR(json["slope_deg"][quantile].get<double>(), 14.0362, 1e-3);
  EXPECT_THAT(ran.err, HasSubstr("warning"));
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

}  // namespace info_command_test
}  // namespace talus::cli
