#include <cmath>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace assess_command_test {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kDrive =
    "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n"
    "80,0.8,0.02,0.5,0.1,0.1\n"   // T/rW 0.1, z/r 0.2
    "80,2.4,0.04,0.5,0.1,0.1\n"   // T/rW 0.3, z/r 0.4
    "80,4.8,0.01,0.5,0.1,0.1\n";  // T/rW 0.6, z/r 0.1

json assessed(const std::vector<std::string>& more) {
  const Folder folder;
  const Ran ran = runTalus(joined({"--json", "assess", folder.write("drive.csv", kDrive)}, more));
  EXPECT_EQ(ran.code, 0) << ran.err;
  return json::parse(ran.out);
}

TEST(AssessCommand, ProbabilitiesOfTheCategoriesAddUp) {
  const json rows = assessed({});
  ASSERT_EQ(rows.size(), 3u);
  for (const json& row : rows) {
    const auto& p = row["probability"];
    EXPECT_NEAR(p["safe"].get<double>() + p["marginal"].get<double>() + p["dangerous"].get<double>(), 1.0,
                1e-9);
  }
  EXPECT_EQ(rows[0]["category"], "dangerous");
  EXPECT_EQ(rows[2]["category"], "safe");
}

TEST(AssessCommand, PlaneFormulaIsEquation321AndBothPrintedPairsAreDangerous) {
  // Printed in: thesis 3.5, pairs (0.1, 0.2) and (0.3, 0.4) at 10 deg. The thesis calls the second pair safe,
  // but Eq. 3.21 gives -0.2 for both pairs.
  const json rows = assessed({"--formula", "plane"});
  for (int k : {0, 1}) {
    EXPECT_NEAR(rows[static_cast<std::size_t>(k)]["drawbar_pull_over_load"].get<double>(), -0.2, 1e-12);
    EXPECT_EQ(rows[static_cast<std::size_t>(k)]["category"], "dangerous");
  }
}

TEST(AssessCommand, SteeperSlopeLowersTheCategory) {
  EXPECT_EQ(assessed({"--slope", "0.6"})[2]["category"], "dangerous");
}

constexpr const char* kSoil =
    "soil: {name: x, cohesion_Pa: 1500, friction_angle_deg: 30, sinkage_exponent: 0.9, cohesive_modulus: 0, "
    "frictional_modulus: 1.7e6, shear_modulus_m: 0.015}\nmodel: wong-reece\n";

TEST(AssessCommand, ModelDeterminesPullAndReadingsDetermineSinkage) {
  // Property: `talus wheel` with the same soil gives the same drawbar pull, independent of the measured
  // torque.
  const Folder folder;
  const std::string model = folder.write("model.yaml", kSoil);
  const json rows = assessed({"--model", model});
  const Ran wheel =
      runTalus({"--json", "wheel", "--soil", model, "--rover",
                folder.write("rover.yaml",
                             "rover: {name: r, mass_kg: 40, gravity_m_s2: 9.81, wheels: {count: 6, "
                             "radius_m: 0.1, width_m: 0.1}, wheelbase_m: 1, track_m: 1, "
                             "clearance_m: 0.3, centre_of_mass_height_m: 0.3, max_pitch_rad: "
                             "0.5, max_roll_rad: 0.5, max_torque_Nm: 10, max_speed_mps: 0.1, "
                             "turning_radius_m: 0, hotel_power_W: 5, steering: skid}\n"),
                "--load", "80", "--slip", "0.5"});
  ASSERT_EQ(wheel.code, 0) << wheel.err;
  const double pull = json::parse(wheel.out)["drawbar_pull_N"].get<double>() / 80.0;
  for (const json& row : rows) {
    EXPECT_NEAR(row["drawbar_pull_over_load"].get<double>(), pull, 1e-5);
    EXPECT_DOUBLE_EQ(row["std"], 0.0);
  }
  EXPECT_NEAR(rows[1]["sinkage_over_radius"].get<double>(), 0.4, 1e-12);
}

TEST(AssessCommand, IgnoredSensorEffectsAreListed) {
  const Folder folder;
  const std::string drive = folder.write("drive.csv", kDrive), plain = folder.write("plain.yaml", kSoil);
  const std::string tilted =
      folder.write("tilted.yaml", std::string(kSoil) +
                                      "effects:\n  - {name: load_cell_tilt, covariate: constant, channel: "
                                      "drawbar_pull_over_load, parameters: [0.1]}\n");
  const Ran without = runTalus({"--json", "assess", drive, "--model", plain});
  const Ran with = runTalus({"--json", "assess", drive, "--model", tilted});
  ASSERT_EQ(with.code, 0) << with.err;
  EXPECT_THAT(with.err, HasSubstr("load_cell_tilt describes a sensor error"));
  EXPECT_EQ(with.out, without.out);
  EXPECT_TRUE(without.err.empty());
}

TEST(AssessCommand, ModelAssessmentNeedsNeitherTorqueNorSinkage) {
  const Folder folder;
  const Ran ran =
      runTalus({"--json", "assess",
                folder.write("bare.csv", "load_N,slip,wheel_radius_m,wheel_width_m\n80,0.5,0.1,0.1\n"),
                "--model", folder.write("model.yaml", kSoil)});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json row = json::parse(ran.out)[0];
  EXPECT_GT(row["sinkage_over_radius"].get<double>(), 0.05);
  EXPECT_GT(row["torque_over_load_radius"].get<double>(), 0.1);
}

TEST(AssessCommand, ExtrapolationUsesTheFittedSoilOrTheModel) {
  // Property: the greatest pull is not below the pull at the reference slip; rows of equal load have equal
  // predictions; a model without parameter uncertainty has a standard deviation of 0.
  const Folder folder;
  const json own = assessed({"--extrapolate"});
  const json model =
      assessed({"--extrapolate", "--reference-slip", "0.3", "--model", folder.write("model.yaml", kSoil)});
  for (const json& row : own) {
    EXPECT_GT(row["at_reference_slip"]["std"].get<double>(), 0.0);
    EXPECT_DOUBLE_EQ(row["at_reference_slip"]["slip"], 0.5);
    EXPECT_GE(row["greatest"]["drawbar_pull_over_load"].get<double>(),
              row["at_reference_slip"]["drawbar_pull_over_load"].get<double>());
    EXPECT_NEAR(std::tan(row["greatest"]["climbable_slope_rad"].get<double>()),
                row["greatest"]["drawbar_pull_over_load"].get<double>(), 1e-9);
    EXPECT_EQ(row["greatest"], own[0]["greatest"]);
  }
  EXPECT_DOUBLE_EQ(model[0]["at_reference_slip"]["slip"], 0.3);
  EXPECT_LT(model[0]["at_reference_slip"]["drawbar_pull_over_load"].get<double>(),
            model[0]["drawbar_pull_over_load"].get<double>());  // measured at slip 0.5
  EXPECT_DOUBLE_EQ(model[0]["greatest"]["std"], 0.0);
  EXPECT_FALSE(assessed({})[0].contains("greatest"));
}

TEST(AssessCommand, ErrorsAreOneLineWithTheirExitCode) {
  const BadFiles files;
  files.folder().write("bad.csv",
                       "load_N,torque_Nm,sinkage_m,wheel_radius_m,wheel_width_m\n0,1,0.01,0.1,0.1\n");
  files.folder().write("nowheel.csv", "load_N,torque_Nm,sinkage_m\n80,1,0.01\n");
  files.folder().write("ok.csv", kDrive);
  files.folder().write("bare.yaml", "model: wong-reece\n");
  expectRefused(files, {{{"assess", "bad.csv"}, 2, "load_N"},
                        {{"assess", "nowheel.csv"}, 2, "--rover"},
                        {{"assess", "ok.csv", "--model", "none.yaml"}, 2, "none.yaml"},
                        {{"assess", "ok.csv", "--model", "sand", "--formula", "plane"}, 2, "--formula"},
                        {{"assess", "nowheel.csv", "--model", "sand"}, 2, "slip"},
                        {{"assess", "ok.csv", "--model", "bare.yaml"}, 2, "soil"},
                        {{"assess", "ok.csv", "--reference-slip", "0"}, 2, "--reference-slip"},
                        {{"assess", "ok.csv", "--slope", "2"}, 2, "slope"}});
}

}  // namespace assess_command_test
}  // namespace talus::cli
