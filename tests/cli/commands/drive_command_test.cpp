#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace drive_command_test {

using nlohmann::json;

// A drive on a flat site of 40 m x 30 m whose map states sandy loam.
std::vector<std::string> drive(const Folder& folder, const std::string& truth,
                               const std::vector<std::string>& more = {}) {
  folder.write("flat.asc", asciiGrid(40, 30, [](int, int) { return 0.0; }));
  folder.write("truth.yaml", truth);
  return joined({"drive", "flat.asc", "--ignore-crs", "--resolution", "1", "--soil", "sandy_loam", "--rover",
                 "sojourner", "--truth", "truth.yaml", "--start", "5,15", "--goal", "35,15"},
                more);
}

// A patch of weak soil on the direct path; the map has no class raster.
const char* const kTrap = R"(soils:
  - {name: trap, cohesion_kPa: 0, friction_angle_deg: 22, sinkage_exponent: 1, cohesive_modulus: 0,
     frictional_modulus: 300000, shear_modulus_mm: 20}
patches:
  - {x_m: 20, y_m: 15, radius_m: 4, soil: trap}
)";

json outcomeOf(const Folder& folder, const std::vector<std::string>& words) {
  const Ran ran = runTalus(words, folder.path());
  EXPECT_TRUE(ran.code == 0 || ran.code == 1) << ran.err;
  return json::parse(ran.out);
}

TEST(DriveCommand, CorrectlyMappedGroundIsTraversedUnderEveryBelief) {
  for (const char* belief : {"geometry", "prior", "online", "clairvoyant"}) {
    const Folder folder;
    const Ran ran = runTalus(drive(folder, "{}\n", {"--belief", belief, "--json"}), folder.path());
    ASSERT_EQ(ran.code, 0) << ran.err;
    const json out = json::parse(ran.out);
    EXPECT_EQ(out["outcome"], "reached") << belief;
    // Closed form: straight line up to 1 m before the goal; the pose error is at most 1 % of the distance.
    EXPECT_NEAR(out["length_m"].get<double>(), 29.0, 0.3) << belief;
    EXPECT_GT(out["energy_J"].get<double>(), 0.0);
    EXPECT_EQ(out["replans"], 0);
    EXPECT_LT(out["max_slip"].get<double>(), 0.5);
    EXPECT_TRUE(out["categories_changed"].is_number_unsigned());
  }
}

// Detected soft patches may enclose the rover; the rover then returns along its own track. A route exists in
// both worlds.
TEST(DriveCommand, RoverEnclosedByItsFindingsReachesTheGoal) {
  const Folder folder;
  folder.write("truth.yaml", R"(random: {spread: 0.1, patches: 10, patch_radius_m: 3, patch_soil: trap}
soils:
  - {name: trap, cohesion_kPa: 0, friction_angle_deg: 22, sinkage_exponent: 1, cohesive_modulus: 1400,
     frictional_modulus: 20000, shear_modulus_mm: 15}
)");
  ASSERT_EQ(
      runTalus({"generate", "rocks", "--size", "160", "--resolution", "0.5", "-o", "site.tif"}, folder.path())
          .code,
      0);
  for (const char* seed : {"600008", "600009"}) {
    const json online =
        outcomeOf(folder, {"drive", "site.tif", "--soil", "sandy_loam", "--rover", "sojourner", "--truth",
                           "truth.yaml", "--start", "8,8", "--goal", "72,72", "--seed", seed, "--belief",
                           "online", "--json", "--quiet"});
    EXPECT_EQ(online["outcome"], "reached") << seed << online["cause"];
  }
}

TEST(DriveCommand, UndeclaredPatchImmobilisesWithoutUpdatesOnly) {
  const Folder folder;
  const Ran blind = runTalus(drive(folder, kTrap, {"--belief", "prior", "--json"}), folder.path());
  EXPECT_EQ(blind.code, 1);
  EXPECT_EQ(json::parse(blind.out)["outcome"], "immobilised");
  const json online = outcomeOf(folder, drive(folder, kTrap, {"--belief", "online", "--json"}));
  EXPECT_EQ(online["outcome"], "reached");
  EXPECT_GE(online["replans"].get<int>(), 1);
  EXPECT_GT(online["categories_changed"].get<int>(), 0);
  const json told = outcomeOf(folder, drive(folder, kTrap, {"--belief", "clairvoyant", "--json"}));
  EXPECT_EQ(told["outcome"], "reached");
  EXPECT_EQ(told["replans"], 0);
  EXPECT_GT(online["length_m"].get<double>(), told["length_m"].get<double>());
}

TEST(DriveCommand, RatesAreIndependentOfThreadsAndParts) {
  const Folder folder;
  const char* const random = "random: {spread: 0.1, patches: 6, patch_radius_m: 2}\n";
  const auto words = drive(folder, random, {"--worlds", "6", "--seed", "11", "--json"});
  auto alone = words, both = words;
  alone.insert(alone.end(), {"--threads", "1"});
  both.insert(both.end(), {"--threads", "2"});
  const Ran one = runTalus(alone, folder.path()), two = runTalus(both, folder.path());
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_EQ(one.out, two.out);
  const auto part = [&](const char* which) {
    auto call = words;
    call.insert(call.end(), {"-o", "parts", "--part", which});
    return runTalus(call, folder.path());
  };
  EXPECT_EQ(part("2/2").out, "part 2/2: 3 of 6 simulations are in parts\n");
  EXPECT_EQ(part("1/2").out, one.out);
  const json out = json::parse(one.out);
  EXPECT_EQ(out["worlds"], 6);
  double sum = 0.0;
  for (const char* outcome : {"reached", "immobilised", "tipped", "gave_up"}) {
    const double rate = out[outcome]["rate"];
    EXPECT_LE(out[outcome]["interval_95"][0].get<double>(), rate);
    EXPECT_GE(out[outcome]["interval_95"][1].get<double>(), rate);
    sum += rate;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(out["each"].size(), 6U);
}

TEST(DriveCommand, BeliefsAreComparedInTheSameWorlds) {
  const Folder folder;
  const json out = outcomeOf(
      folder, drive(folder, "random: {spread: 0.05}\n", {"--worlds", "3", "--belief", "all", "--json"}));
  EXPECT_EQ(out["worlds"], 3);
  EXPECT_EQ(out["clairvoyant"]["energy_over_clairvoyant"]["mean"], 1.0);
  for (const char* belief : {"geometry", "prior", "online"})
    EXPECT_TRUE(out[belief]["immobilised"].contains("interval_95")) << belief;
}

TEST(DriveCommand, PageShowsTheDrive) {
  const Folder folder;
  const json out = outcomeOf(folder, drive(folder, kTrap, {"--html", "r.html", "--json"}));
  EXPECT_EQ(out, outcomeOf(folder, drive(folder, kTrap, {"--json"})));
  const std::string page = fileContent(folder / "r.html");
  for (const char* part : {"\"story\":{\"track\":[[", "\"text\":\"planned\"", "reversed", "id=\"moment\"",
                           "\"letter\":\"G\"", "\"name\":\"predicted before each step\""})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(DriveCommand, TruthFileAcceptsAllPartsTogether) {
  // Property: declaring the true soil of a class equal to the mapped soil does not change the result.
  const Folder folder;
  const std::string others =
      "patches:\n  - {x_m: 10, y_m: 10, radius_m: 1, soil: dry_sand}\nrandom: {spread: 0.1}\n"
      "effects: [{name: bulldozing, parameters: [0.1]}]\n";
  const json alone = outcomeOf(folder, drive(folder, others, {"--json"}));
  EXPECT_EQ(outcomeOf(folder, drive(folder, "classes: {0: sandy_loam}\n" + others, {"--json"})), alone);
}

TEST(BadInput, InvalidDriveCallsAreRejectedWithOneLine) {
  const BadFiles files;
  const auto write = [&](const char* name, const char* text) { files.folder().write(name, text); };
  write("t_key.yaml", "patchs: []\n");
  write("t_class.yaml", "classes: {7: dry_sand}\n");
  write("truth.yaml", "{}\n");
  const auto call = [](const std::string& truth, std::vector<std::string> more = {}) {
    return joined({"drive", "good.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido",
                   "--truth", truth, "--start", "5,5", "--goal", "15,15"},
                  more);
  };
  expectRefused(files, {
                           {{"drive"}, 2, ""},
                           {call("missing.yaml"), 2, "missing.yaml"},
                           {call("t_key.yaml"), 2, "patches"},
                           {call("t_class.yaml"), 2, "class 7 is not a class of the map"},
                           {call("truth.yaml", {"--belief", "faith"}), 2, "faith"},
                           {call("truth.yaml", {"--worlds", "0"}), 2, "--worlds"},
                           {call("truth.yaml", {"--worlds", "2", "--html", "r.html"}), 2, "--html"},
                           {call("truth.yaml", {"--html", "no/r.html"}), 2, "no/r.html"},
                       });
}

}  // namespace drive_command_test
}  // namespace talus::cli
