#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace score_command_test {

using nlohmann::json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

// Undulations with a wavelength of two wheelbases, whose slope over the footprint of the map is small: score
// refuses the path only with --chassis, and accepts the route of plan --chassis.
TEST(ScoreCommand, ChassisCheckIsAppliedOnRequest) {
  const Folder folder;
  std::string text = "ncols 60\nnrows 50\nxllcorner 0\nyllcorner 0\ncellsize 0.2\nNODATA_value -9999\n";
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 60; ++column)
      text += std::to_string(column >= 20 && column < 38 && row > 14
                                 ? 0.03 * std::sin(std::numbers::pi * column / 6)
                                 : 0.0) +
              " ";
    text += "\n";
  }
  folder.write("swells.asc", text);
  folder.write(
      "low.yaml",
      "name: low\nmass_kg: 40\ngravity_m_s2: 3.71\nwheelbase_m: 1.2\ntrack_m: 0.8\nclearance_m: 0.3\n"
      "centre_of_mass_height_m: 0.3\nmax_pitch_deg: 2.5\nmax_roll_deg: 25\nmax_torque_Nm: 30\n"
      "max_speed_mps: 0.1\nturning_radius_m: 0\nhotel_power_W: 5\nsteering: all_wheel\n"
      "wheels: {count: 4, radius_m: 0.15, width_m: 0.1, grouser_height_m: 0.01, grouser_count: 20}\n");
  folder.write("over.csv", "x_m,y_m\n2,2\n10,2\n");
  const auto run = [&folder](const std::string& call, const std::vector<std::string>& more) {
    std::vector<std::string> words{call,      "swells.asc", "--resolution", "0.2", "--soil", "sandy_loam",
                                   "--rover", "low.yaml",   "--footprint",  "2",   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return runTalus(words, folder.path());
  };
  EXPECT_EQ(run("score", {"--path", "over.csv"}).code, 0);
  const Ran held = run("score", {"--path", "over.csv", "--chassis", "rigid"});
  EXPECT_EQ(held.code, 1);
  EXPECT_EQ(json::parse(held.out)["status"], "infeasible");
  EXPECT_THAT(held.out, HasSubstr("chassis pitch above its limit"));
  const Ran around =
      run("plan", {"--start", "2,2", "--goal", "10,2", "--chassis", "rigid", "-o", "r.geojson"});
  ASSERT_EQ(around.code, 0) << around.err;
  EXPECT_GT(json::parse(around.out)["length_m"], 10.0);
  EXPECT_EQ(run("score", {"--path", "r.geojson", "--chassis", "rigid"}).code, 0);
}

TEST(ScoreCommand, ErrorsAreOneLineWithTheirExitCode) {
  const BadFiles files;
  const auto score = [](const Words& more) {
    Words words{"score", "good.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expectRefused(files, {
                           {score({}), 2, "--path"},
                           {score({"--path", "missing.csv"}), 2, "missing.csv"},
                           {score({"--path", "empty.csv"}), 2, "empty.csv"},
                           {score({"--path", "head_only.csv"}), 2, "head_only.csv"},
                           {score({"--path", "wrong_columns.csv"}), 2, "wrong_columns.csv"},
                           {score({"--path", "words.csv"}), 2, "words.csv"},
                           {score({"--path", "garbage.csv"}), 2, "garbage.csv"},
                           {score({"--path", "text.json"}), 2, "text.json"},
                           {score({"--path", "point_less.json"}), 2, "point_less.json"},
                           {score({"--path", "folder"}), 2, "folder"},
                           {score({"--path", "text.json", "--chassis", "tank"}), 2, "--chassis"},
                       });
}

}  // namespace score_command_test
}  // namespace talus::cli
