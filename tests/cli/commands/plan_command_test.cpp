#include <algorithm>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace plan_command_test {

using nlohmann::json;
using ::testing::HasSubstr;

// 30 x 20 cells of 1 m: flat, with a wall along x = 15 that ends in the south, and a ramp that rises
// eastwards from x = 20.
std::string dem() {
  return asciiGrid(30, 20, [](int column, int row) {
    return column == 15 && row < 13 ? 5.0 : std::max(0.0, 0.1 * (column - 20));
  });
}

// Property: a plan that keeps out of the unsafe area costs little more; a corridor does not change the route; the proof
// reaches a stated gap; a line is scored against the best route.
TEST(PlanCommand, AreasAndGapAreAsStated) {
  const Folder folder;
  folder.write("dem.asc", dem());
  folder.write("far.csv", "x_m,y_m\n5.5,4.5\n12.5,17.5\n18.5,17.5\n26.5,4.5\n");
  const auto run = [&folder](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(),
                 {"dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido", "--json"});
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = runTalus(words, folder.path());
    EXPECT_NE(ran.code, 2) << ran.err;
    return json::parse(ran.out);
  };
  const std::vector<std::string> ends{"--start", "5.5,4.5", "--goal", "26.5,4.5"};
  const auto plan = [&](std::vector<std::string> more) {
    more.insert(more.end(), ends.begin(), ends.end());
    return run({"plan"}, more);
  };
  const json best = plan({});
  run({"costmap"}, {"--unsafe", "unsafe.gpkg"});
  const json around = plan({"--keep-out", "unsafe.gpkg"});  // grown by half the rover's width
  EXPECT_GE(around["cost"], best["cost"]);
  EXPECT_LE(around["cost"].get<double>(), 1.3 * best["cost"].get<double>());
  EXPECT_EQ(plan({"--corridor", "5", "-o", "area.gpkg"})["cost"], best["cost"]);
  EXPECT_TRUE(std::filesystem::exists(folder / "area.gpkg"));
  EXPECT_LE(plan({"--gap", "0.5"})["gap"].get<double>(), 0.5 / (1.0 - 0.5));
  const json scored = run({"score", "--prove"}, {"--path", "far.csv"});
  EXPECT_EQ(scored["best_cost"], best["cost"]);
  EXPECT_GE(scored["lower_bound"].get<double>(), 0.9 * best["lower_bound"].get<double>());
  EXPECT_GT(scored["cost"], best["cost"]);
  EXPECT_LE(run({"score"}, {"--path", "far.csv"})["lower_bound"], best["cost"]);
}

// All outputs of a feasible plan are tested in one run, because the start of the program dominates the time.
TEST(PlanCommand, PlannedRouteIsWrittenAndScoresTheSameCost) {
  const Folder folder;
  folder.write("dem.asc", dem());
  const std::vector<std::string> ground{"dem.asc",    "--resolution", "1",   "--soil",
                                        "sandy_loam", "--rover",      "fido"};
  const auto with = [&ground](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), ground.begin(), ground.end());
    return joined(words, more);
  };
  const Ran plan =
      runTalus(with({"plan", "--json"}, {"--start", "5.5,4.5", "--goal", "26.5,4.5", "-o", "route.geojson"}),
               folder.path());
  ASSERT_EQ(plan.code, 0) << plan.err;
  const json summary = json::parse(plan.out);
  for (const char* key : {"status", "cost", "energy_J", "time_s", "length_m", "max_slip", "max_slope_rad",
                          "lower_bound", "gap", "planner", "seconds"})
    EXPECT_TRUE(summary.contains(key)) << key;
  EXPECT_EQ(summary["status"], "found");
  EXPECT_GT(summary["length_m"].get<double>(), 21.0);
  EXPECT_LE(summary["lower_bound"].get<double>(), summary["cost"].get<double>());
  for (const char* key : {"load", "costmap", "plan", "proof"})
    EXPECT_TRUE(summary["seconds"].contains(key)) << key;
  EXPECT_GT(summary["seconds"]["proof"].get<double>(), 0.0);
  EXPECT_LT(summary["seconds"]["proof"].get<double>(), summary["seconds"]["plan"].get<double>());

  const json route = json::parse(fileContent(folder / "route.geojson"));
  EXPECT_EQ(route["crs"], "local");
  const json& feature = route["features"][0];
  EXPECT_EQ(feature["geometry"]["type"], "LineString");
  const std::size_t count = feature["geometry"]["coordinates"].size();
  for (const char* key : {"x_m", "y_m", "elevation_m", "heading_rad", "slope_along_rad", "slope_across_rad",
                          "slip", "sinkage_m", "torque_Nm", "drawbar_pull_margin", "category", "energy_J",
                          "time_s", "immobilisation_risk"})
    EXPECT_EQ(feature["properties"][key].size(), count) << key;
  EXPECT_EQ(feature["properties"]["inputs"]["files"][0]["file"], "dem.asc");
  EXPECT_EQ(feature["properties"]["inputs"]["rover"], "fido");
  EXPECT_THAT(feature["properties"]["inputs"]["command"].get<std::string>(),
              testing::StartsWith("talus plan "));
  EXPECT_EQ(feature["properties"]["inputs"]["files"][0]["sha256"].get<std::string>().size(), 64U);

  const Ran score = runTalus(with({"score", "--json"}, {"--path", "route.geojson"}), folder.path());
  ASSERT_EQ(score.code, 0) << score.err;
  const json scored = json::parse(score.out);
  EXPECT_NEAR(scored["cost"].get<double>(), summary["cost"].get<double>(),
              1e-6 * summary["cost"].get<double>());
  EXPECT_TRUE(scored["violations"].empty());

  folder.write("wall.csv", "x_m,y_m\n5.5,4.5\n26.5,4.5\n");
  const Ran wall = runTalus(with({"score", "--json"}, {"--path", "wall.csv"}), folder.path());
  EXPECT_EQ(wall.code, 1);
  const json refused = json::parse(wall.out);
  EXPECT_FALSE(refused["violations"].empty());
  EXPECT_TRUE(refused["violations"][0].contains("reason"));

  const Ran back =
      runTalus(with({"plan", "--json"}, {"--start", "26.5,4.5", "--goal", "5.5,4.5"}), folder.path());
  ASSERT_EQ(back.code, 0) << back.err;
  EXPECT_LT(json::parse(back.out)["energy_J"].get<double>(), summary["energy_J"].get<double>());
}

TEST(PlanCommand, MissionFileSuffices) {
  const Folder folder;
  folder.write("dem.asc", dem());
  folder.write("mission.yaml",
               "maps: {dem: dem.asc, resolution_m: 1}\nrover: fido\nsoil: sandy_loam\nstart: [5.5, 4.5]\n"
               "goal: [10.5, 9.5]\nplanner: field\nthresholds: {allow_marginal: true}\n");
  const Ran ran = runTalus({"plan", "mission.yaml", "--json"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(json::parse(ran.out)["status"], "found");
}

TEST(PlanCommand, CheapestGoalIsChosenAndViaPointsArePassed) {
  const Folder folder;
  folder.write("dem.asc", dem());
  const auto plan = [&folder](const std::vector<std::string>& more) {
    return runTalus(joined({"plan", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido",
                            "--start", "5.5,4.5", "--goal", "26.5,4.5", "--goal", "10.5,9.5"},
                           more),
                    folder.path());
  };
  const Ran json_run = plan({"--json"});
  ASSERT_EQ(json_run.code, 0) << json_run.err;
  EXPECT_EQ(json::parse(json_run.out)["goal"], "10.5,9.5");
  EXPECT_THAT(plan({}).out, HasSubstr("10.5,9.5, number 2 of 2"));
  EXPECT_THAT(plan({"--in-memory", "10"}).err, HasSubstr("several goals"));

  folder.write("mission.yaml",
               "maps: {dem: dem.asc, resolution_m: 1}\nrover: fido\nsoil: sandy_loam\nstart: [5.5, 4.5]\n"
               "goal: [[26.5, 4.5], '10.5,9.5']\nvia: [[5.5, 8.5], [8.5, 8.5]]\n");
  const Ran mission = runTalus({"plan", "mission.yaml", "--json", "-o", "r.geojson"}, folder.path());
  ASSERT_EQ(mission.code, 0) << mission.err;
  EXPECT_EQ(json::parse(mission.out)["goal"], "10.5,9.5");
  const json route = json::parse(fileContent(folder / "r.geojson"))["features"][0]["properties"];
  const auto passed = [&](double x, double y) {
    for (std::size_t i = 0; i < route["x_m"].size(); ++i)
      if (route["x_m"][i] == x && route["y_m"][i] == y) return true;
    return false;
  };
  EXPECT_TRUE(passed(5.5, 8.5) && passed(8.5, 8.5));

  folder.write("bad.yaml", "maps: {dem: dem.asc}\nstart: [5.5, 4.5]\ngoal:\n  - {x: 1}\n");
  const Ran bad = runTalus({"plan", "bad.yaml"}, folder.path());
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.yaml:4"));
}

// Property: a route planned window by window is valid on the full map, has the same cost there, and costs at
// most 5 % more or less than the route planned on the full map.
TEST(PlanCommand, WindowedPlanMatchesThePlanOnTheFullMap) {
  const Folder folder;
  const Ran made =
      runTalus({"generate", "craters", "--size", "900x700", "--seed", "7", "-o", "dem.tif"}, folder.path());
  ASSERT_EQ(made.code, 0) << made.err;
  const auto plan = [&folder](const std::vector<std::string>& more) {
    return runTalus(joined({"plan", "dem.tif", "--soil", "sandy_loam", "--rover", "fido", "--json", "--start",
                            "60,60", "--goal", "820,620"},
                           more),
                    folder.path());
  };
  const Ran whole = plan({}), windows = plan({"--in-memory", "100000", "-o", "windows.geojson"});
  ASSERT_EQ(whole.code, 0) << whole.err;
  ASSERT_EQ(windows.code, 0) << windows.err;
  const double whole_J = json::parse(whole.out)["cost"], windows_J = json::parse(windows.out)["cost"];
  EXPECT_NEAR(windows_J, whole_J, 0.05 * whole_J);
  const json route = json::parse(fileContent(folder / "windows.geojson"));
  for (const auto& height : route["features"][0]["properties"]["elevation_m"])
    ASSERT_TRUE(height.is_number());
  const Ran score = runTalus(
      {"score", "dem.tif", "--soil", "sandy_loam", "--rover", "fido", "--json", "--path", "windows.geojson"},
      folder.path());
  ASSERT_EQ(score.code, 0) << score.err;
  EXPECT_NEAR(json::parse(score.out)["cost"].get<double>(), windows_J, 1e-6 * windows_J);
  EXPECT_EQ(plan({"--in-memory", "1000000000"}).out.substr(0, 60), whole.out.substr(0, 60));
}

TEST(PlanCommand, UnsupportedWindowedPlanningIsRejected) {
  const Folder folder;
  folder.write("dem.asc", dem());
  const Ran ran = runTalus({"plan", "dem.asc", "--resolution", "1", "--start", "5.5,4.5", "--goal",
                            "26.5,4.5", "--in-memory", "100", "--planner", "RRTstar"},
                           folder.path());
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("--in-memory"));
}

}  // namespace plan_command_test
}  // namespace talus::cli
