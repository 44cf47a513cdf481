#include <algorithm>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "beyond_memory.hpp"

namespace talus::cli {
namespace plugin_routes_test {

using nlohmann::json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

// Level ground of 40 m x 20 m with an area without data from y = 8 to the north edge, which a rover cannot
// cross.
class PluginRoutes : public testing::Test {
 protected:
  PluginRoutes() {
    folder_.write("wall.asc", asciiGrid(40, 20, [](int column, int row) {
                    return row >= 8 && column >= 19 && column < 22 ? -9999.0 : 0.0;
                  }));
    folder_.write("truth.yaml", "{}\n");
  }

  Ran run(const std::string& call, const Words& more) const {
    return runTalus(joined({call, "wall.asc", "--quiet", "--ignore-crs", "--resolution", "1", "--soil",
                            "sandy_loam", "--rover", "fido"},
                           more),
                    folder_.path());
  }
  Ran plan(const std::string& planner, const Words& more = {}) const {
    return run("plan", joined({"--plugin", TALUS_STRAIGHT_PLUGIN, "--planner", planner, "--start", "5,4",
                               "--goal", "35,4", "-o", "r.geojson", "--json"},
                              more));
  }

  Folder folder_;
};

TEST_F(PluginRoutes, PluginRoutesAreCheckedAndPriced) {
  const Ran planned = plan("line");
  ASSERT_EQ(planned.code, 0) << planned.err;
  const json route = json::parse(planned.out);
  EXPECT_EQ(route["planner"], "line of straight");
  EXPECT_NEAR(route["length_m"], 30.0, 1e-9);  // Closed form: straight
  const Ran scored = run("score", {"--path", "r.geojson", "--json"});
  // The route file has one vertex per cell; the cost is the same sum over other pieces.
  EXPECT_NEAR(double(json::parse(scored.out)["cost"]), double(route["cost"]), 1e-9 * double(route["cost"]));
  EXPECT_GE(double(route["cost"]), double(route["lower_bound"]));
  const Ran direct =
      run("score", {"--plugin", TALUS_STRAIGHT_PLUGIN, "--start", "5,4", "--goal", "35,4", "--json"});
  EXPECT_EQ(direct.code, 0) << direct.err;
  EXPECT_EQ(json::parse(direct.out)["cost"], route["cost"]);
}

TEST_F(PluginRoutes, InvalidPluginRoutesAreRejectedAndScoredWithViolations) {
  const Words places{"--start", "5,14", "--goal", "35,14"};
  const Ran planned = run("plan", joined({"--plugin", TALUS_STRAIGHT_PLUGIN, "-o", "r.geojson"}, places));
  EXPECT_EQ(planned.code, 1);
  EXPECT_THAT(planned.err, HasSubstr("the check refuses that of line of straight: at 1"));
  EXPECT_EQ(std::count(planned.err.begin(), planned.err.end(), '\n'), 1) << planned.err;
  EXPECT_EQ(fileContent(folder_.path() / "r.geojson"), "");
  const Ran scored =
      run("score", {"--plugin", TALUS_STRAIGHT_PLUGIN, "--start", "5,14", "--goal", "35,14", "--json"});
  EXPECT_EQ(scored.code, 1);
  EXPECT_GE(json::parse(scored.out)["violations"].size(), 3U);
}

TEST_F(PluginRoutes, PluginErrorsAreOneLine) {
  struct Wrong {
    const char* planner;
    int code;
    const char* said;
  };
  for (const Wrong& wrong : {Wrong{"throws", 2, "threw an error: no idea at all"},
                             {"odd", 2, "no std::exception"},
                             {"undefined", 2, "vertex 1 is nan"},
                             {"crashes", 2, "ended its process (Aborted)"},
                             {"huge", 2, kBeyondMemory},
                             {"empty", 2, "without a vertex"},
                             {"elsewhere", 1, "it ends at 36"},
                             {"winding", 1, "cells long, must be at most 1000000"},
                             {"lines", 2, "has no planner 'lines'"}}) {
    const Ran ran = plan(wrong.planner);
    EXPECT_EQ(ran.code, wrong.code) << wrong.planner << ": " << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(wrong.said)) << wrong.planner;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(fileContent(folder_.path() / "r.geojson"), "") << wrong.planner;
  }
  const Ran endless = plan("endless", {"--time", "0.2"});
  EXPECT_EQ(endless.code, 2) << endless.err;
  EXPECT_THAT(endless.err, HasSubstr("did not end within its time limit"));
  EXPECT_EQ(run("score", {"--path", "r.csv", "--time", "1"}).code, 2);  // --time without --plugin
}

// The plugin declares that it respects headings and turning radius, but its route does not.
TEST_F(PluginRoutes, HeadingsAreCheckedAgainstTheRoute) {
  const auto lied = [this](const Words& motion) {
    const Ran ran = plan("liar", joined({"--turning-radius", "2"}, motion));
    EXPECT_EQ(ran.code, 1) << ran.err;
    return ran.err;
  };
  EXPECT_THAT(lied({"--start-heading", "1"}), HasSubstr("does not leave on the start heading"));
  EXPECT_THAT(lied({"--goal-heading", "1"}), HasSubstr("does not arrive on the goal heading"));
  EXPECT_EQ(plan("liar", {"--turning-radius", "2", "--start-heading", "0", "--goal-heading", "0"}).code, 0);
}

TEST_F(PluginRoutes, UnusablePluginsAreRejectedWithOneLine) {
  const auto with = [&](const std::string& file, const Words& more = {}) {
    const Ran ran = run("plan", joined({"--plugin", file, "--start", "5,4", "--goal", "35,4"}, more));
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    return ran.err;
  };
  EXPECT_THAT(with(TALUS_OTHER_PLUGIN), HasSubstr("built for planner interface 99, this program has 9"));
  EXPECT_THAT(with("none.so"), HasSubstr("none.so: no such file"));
  EXPECT_THAT(with("wall.asc"), HasSubstr("cannot be loaded"));
  EXPECT_THAT(with(TALUS_STRAIGHT_PLUGIN, {"--via", "20,4"}), HasSubstr("via is not honoured"));
  EXPECT_THAT(with(TALUS_STRAIGHT_PLUGIN, {"--start-heading", "0"}),
              HasSubstr("start_heading_rad is not honoured"));
  EXPECT_THAT(with(TALUS_STRAIGHT_PLUGIN, {"--risk", "0.1"}), HasSubstr("cannot be combined"));
  EXPECT_EQ(run("score", {"--plugin", TALUS_STRAIGHT_PLUGIN}).code, 2);
}

TEST_F(PluginRoutes, PluginPlannersCanBeBenchmarkedAndDriven) {
  const Ran bench = runTalus({"bench", "wall.asc", "--quiet", "--ignore-crs", "--resolution", "1", "--soil",
                              "sandy_loam", "--rover", "fido", "--planners", "field", "--plugin",
                              TALUS_STRAIGHT_PLUGIN, "--runs", "1", "--pairs", "4", "--json"},
                             folder_.path());
  ASSERT_EQ(bench.code, 0) << bench.err;
  const json line = json::parse(bench.out)[1];
  EXPECT_EQ(line["planner"], "line of straight");
  EXPECT_GT(int(line["breached"]), 0);  // between some pairs lies the wall
  EXPECT_EQ(int(line["found"]) + int(line["breached"]), 4);
  const Ran drive = run("drive", {"--plugin", TALUS_STRAIGHT_PLUGIN, "--truth", "truth.yaml", "--start",
                                  "5,4", "--goal", "15,4", "--belief", "prior", "--json"});
  EXPECT_EQ(drive.code, 0) << drive.err;
  EXPECT_EQ(json::parse(drive.out)["outcome"], "reached");
  const Ran walled = run("drive", {"--plugin", TALUS_STRAIGHT_PLUGIN, "--truth", "truth.yaml", "--start",
                                   "5,14", "--goal", "35,14", "--belief", "prior", "--json"});
  EXPECT_EQ(walled.code, 1) << walled.err;
}

}  // namespace plugin_routes_test
}  // namespace talus::cli
