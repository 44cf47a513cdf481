#include <algorithm>

#include <CLI/CLI.hpp>

#include <talus/cli/ground/mission.hpp>
#include <talus/common/common.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "run_program.hpp"

namespace talus::cli {

namespace mission_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kMission =
    "maps: {dem: dem.tif, terrain: classes.tif, keep_out: area.json, resolution_m: 2}\n"
    "rover: mer\nsoils: soils.yaml\n"
    "thresholds: {slope_margin_deg: 10, allow_marginal: true, risk_weight_J: 5e6, time_weight_W: 3}\n"
    "planner: hybrid\nstart: [1, 2]\ngoal: [[10, 20], '30,40']\nvia: '5,6'\n"
    "tolerance_m: 1.5\ntime_s: 20\nstart_heading_deg: 90\nreverse: false\noutput: r.geojson\n";

// Reads a mission as `talus plan m.yaml WORDS` does.
PlanOptions readIn(const Folder& folder, std::vector<std::string> words = {},
                   const std::string& mission = kMission) {
  CLI::App call;
  PlanOptions options;
  bindPlan(call, options);
  words.insert(words.begin(), folder.write("m.yaml", mission));
  std::ranges::reverse(words);
  call.parse(words);
  readMission(options);
  options.ground.call = nullptr;
  return options;
}

// Closed form: degrees are converted to radians; paths are relative to the mission, names of the library
// unchanged.
TEST(Mission, EveryMissionFieldIsRead) {
  const Folder folder;
  folder.write("dem.tif", "x");
  folder.write("soils.yaml", "x");
  const PlanOptions plan = readIn(folder);
  EXPECT_EQ(plan.ground.elevation.path, folder / "dem.tif");
  EXPECT_EQ(plan.ground.soils, folder / "soils.yaml");
  EXPECT_EQ(plan.ground.classes, folder / "classes.tif");  // not read here
  EXPECT_EQ(plan.ground.rover, "mer");
  EXPECT_THAT(plan.ground.keep_out, ElementsAre(folder / "area.json"));
  EXPECT_EQ(plan.ground.elevation.read.resolution_m, 2.0);
  EXPECT_NEAR(plan.ground.policy.slope_margin_rad, 10.0 * kDegree, 1e-12);
  EXPECT_EQ(plan.ground.policy.risk_weight_J, 5e6);
  EXPECT_EQ(plan.planner, "hybrid");
  EXPECT_EQ(plan.start, "1,2");
  EXPECT_THAT(plan.goals, ElementsAre("10,20", "30,40"));
  EXPECT_THAT(plan.via, ElementsAre("5,6"));
  EXPECT_NEAR(*plan.drive.start_heading_rad, 90.0 * kDegree, 1e-12);
  EXPECT_TRUE(plan.drive.no_reverse);
  EXPECT_EQ(plan.tolerance_m, 1.5);
  EXPECT_EQ(plan.time_limit_s, 20.0);
  EXPECT_EQ(plan.output, folder / "r.geojson");
}

// Property: values from the command line have precedence over the mission file, such as stricter thresholds.
TEST(Mission, CommandLineOverridesTheMission) {
  const Folder folder;
  const PlanOptions plan =
      readIn(folder, {"--rover", "fido", "--resolution", "0.5", "--no-marginal", "--risk-weight", "7e8",
                      "--goal", "3,3", "--planner", "RRTstar", "--tolerance", "0.25", "--start-heading",
                      "0.1", "--keep-out", "own.json"});
  EXPECT_EQ(plan.ground.rover, "fido");
  EXPECT_EQ(plan.ground.elevation.path, folder / "dem.tif");
  EXPECT_EQ(plan.ground.elevation.read.resolution_m, 0.5);
  EXPECT_FALSE(plan.ground.policy.allow_marginal);
  EXPECT_EQ(plan.ground.policy.risk_weight_J, 7e8);
  EXPECT_EQ(plan.ground.policy.time_weight_W, 3.0);  // not given on the command line
  EXPECT_THAT(plan.goals, ElementsAre("3,3"));
  EXPECT_EQ(plan.planner, "RRTstar");
  EXPECT_EQ(plan.tolerance_m, 0.25);
  EXPECT_EQ(plan.drive.start_heading_rad, 0.1);
  EXPECT_THAT(plan.ground.keep_out, ElementsAre("own.json", folder / "area.json"));  // both apply
}

// Property: an option that equals its default value has precedence, too.
TEST(Mission, DefaultsStatedOnTheCommandLineOverrideTheMission) {
  const Folder folder;
  const PlanOptions plan =
      readIn(folder, {"--planner", "field", "--tolerance", "0", "--slope-uncertainty-deg", "5",
                      "--time-weight", "1", "--risk-weight", "1e8"});
  EXPECT_EQ(plan.planner, "field");
  EXPECT_EQ(plan.tolerance_m, 0.0);
  EXPECT_EQ(plan.ground.policy, costmap::TravelPolicy{});
  const PlanOptions other = readIn(folder, {"--soil", "sand"}, "maps: {dem: dem.tif}\nmodel: m.yaml\n");
  EXPECT_EQ(other.ground.soil, "sand");
  EXPECT_EQ(other.ground.model, "");  // would take the place of the soil
}

TEST(Mission, ErrorsNameFileAndField) {
  const Folder folder;
  const auto refused = [&folder](const std::string& text) {
    return [path = folder.write("bad.yaml", text)] {
      PlanOptions options;
      options.ground.elevation.path = path;
      readMission(options);
    };
  };
  EXPECT_THAT(refused("maps: {dem: a.tif}\ngoals: [1, 2]\n"), ThrowsMessage<InputError>(HasSubstr("goal")));
  EXPECT_THAT(refused("maps: {terrain: a.tif}\n"), ThrowsMessage<InputError>(HasSubstr("defines no map")));
  EXPECT_THAT(refused("maps: {dem: a.tif}\nthresholds: {allow_marginal: maybe}\n"),
              ThrowsMessage<InputError>(HasSubstr("bad.yaml:2")));
  EXPECT_THAT(refused("maps: {dem: a.tif}\ntime_s: -1\n"),
              ThrowsMessage<InputError>(HasSubstr("bad.yaml:2")));
  EXPECT_THAT(refused("maps: {dem: a.tif}\noutput: \"\"\n"),
              ThrowsMessage<InputError>(HasSubstr("output is empty")));
  for (const char* number : {"tolerance_m: -1", "tolerance_m: -1e14", "tolerance_m: ''",
                             "tolerance_m:", "time_s: 0", "tolerance_m: 010", "rover:", "goal: ''",
                             "goal:", "start: ' '", "planner: ''", "reverse:", "thresholds:"})
    EXPECT_THAT(refused(std::string("maps: {dem: a.tif}\n") + number + "\n"),
                ThrowsMessage<InputError>(HasSubstr("bad.yaml:")))
        << number;
  EXPECT_THAT(refused("maps: {dem: a.tif}\ntolerance_m: -1\n"),
              ThrowsMessage<InputError>(HasSubstr("tolerance_m = -1, must be finite, >= 0")));
  EXPECT_THAT(refused("maps: {dem: a.tif, keep_out: ''}\n"),
              ThrowsMessage<InputError>(HasSubstr("keep_out is empty")));
  EXPECT_THAT(refused("maps: {dem: a.tif}\n---\nmaps: {dem: b.tif}\n"),
              ThrowsMessage<InputError>(HasSubstr("more than one YAML document")));
  EXPECT_THAT(refused("rover: mer\n"), ThrowsMessage<InputError>(HasSubstr("maps")));
}

planner::Truth read(const std::string& text) {
  const Folder folder;
  return readTruth(folder.write("truth.yaml", text));
}

TEST(TruthFile, EveryPartIsOptional) {
  const planner::Truth truth = read("{}\n");
  EXPECT_TRUE(truth.classes.empty() && truth.patches.empty() && truth.effects.empty());
  EXPECT_EQ(truth.spread, 0.0);
  EXPECT_EQ(truth.random_patches, 0);
  EXPECT_EQ(truth.patch_soil.name, terramech::loadSoil("mars_drift").name);
}

TEST(TruthFile, EveryFieldIsRead) {
  const planner::Truth truth = read(
      "classes: {1: dry_sand, 4: sandy_loam}\n"
      "patches: [{x_m: 40, y_m: 25, radius_m: 4, soil: dry_sand},\n"
      "          {x_cm: 100, y_m: -3, radius_m: 2, soil: sandy_loam}]\n"
      "random: {spread: 0.1, patches: 8, patch_radius_m: 2.5, patch_soil: dry_sand}\n"
      "effects: [{name: slip_sinkage_ding, parameters: [0.4]}]\n");
  ASSERT_EQ(truth.classes.size(), 2U);
  EXPECT_EQ(truth.classes.at(4).cohesion_Pa, terramech::loadSoil("sandy_loam").cohesion_Pa);
  ASSERT_EQ(truth.patches.size(), 2U);
  EXPECT_EQ(truth.patches[0].centre, (maps::Point{40, 25}));
  EXPECT_EQ(truth.patches[0].radius_m, 4.0);
  EXPECT_EQ(truth.patches[1].centre, (maps::Point{1, -3}));
  EXPECT_EQ(truth.patches[1].soil.name, terramech::loadSoil("sandy_loam").name);
  EXPECT_EQ(truth.spread, 0.1);
  EXPECT_EQ(truth.random_patches, 8);
  EXPECT_EQ(truth.patch_radius_m, 2.5);
  EXPECT_EQ(truth.patch_soil.name, terramech::loadSoil("dry_sand").name);
  ASSERT_EQ(truth.effects.size(), 1U);
  EXPECT_EQ(truth.effects[0].parameters, (std::vector<double>{0.4}));
}

TEST(TruthFile, ErrorsNameTheField) {
  const std::pair<const char*, const char*> cases[] = {
      {"random: {spread: 1.5}\n", "spread must lie in [0, 1]"},
      {"random: {spread: .nan}\n", "spread"},
      {"random: {patches: -1}\n", "patches must lie in"},
      {"random: {patch_radius_m: 0}\n", "patch_radius_m must be > 0"},
      {"patches: [{x_m: .inf, y_m: 2, radius_m: 3, soil: dry_sand}]\n", "x_m"},
      {"patches: [{x_m: 1, y_m: 2, radius_m: -3, soil: dry_sand}]\n", "radius_m must be > 0"},
      {"patches: [{x_m: 1, y_m: 2, radius_m: 3, soil: no_such}]\n", "no_such"},
      {"patchs: []\n", "patches"}};
  for (const auto& each : cases)
    EXPECT_THAT([&] { read(each.first); }, ThrowsMessage<InputError>(HasSubstr(each.second))) << each.first;
}

}  // namespace mission_test

}  // namespace talus::cli
