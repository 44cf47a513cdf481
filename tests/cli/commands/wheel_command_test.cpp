#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace wheel_command_test {

using testing::HasSubstr;
using testing::StartsWith;

TEST(WheelCommand, ForcesArePrintedAsTextAndJson) {
  const std::vector<std::string> call{"wheel",  "--soil", "sand",   "--rover", "mer",
                                      "--load", "100",    "--slip", "0.3"};
  const Ran plain = runTalus(call);
  EXPECT_EQ(plain.code, 0) << plain.err;
  EXPECT_THAT(plain.out, HasSubstr("drawbar pull"));
  auto with_json = call;
  with_json.insert(with_json.begin(), "--json");
  const auto json = nlohmann::json::parse(runTalus(with_json).out);
  for (const char* field : {"sinkage_m", "entry_angle_rad", "torque_Nm", "drawbar_pull_N"})
    EXPECT_TRUE(json.at(field).is_number()) << field;
}

TEST(WheelCommand, SideForceIsOddInSlipAngle) {
  std::vector<std::string> call{"wheel",  "--soil", "sand",   "--rover",     "mer",
                                "--slip", "0.2",    "--json", "--slip-angle"};
  const auto side = [&](const std::string& angle) {
    auto full = call;
    full.push_back(angle);
    return nlohmann::json::parse(runTalus(full).out)["side_force_N"].get<double>();
  };
  EXPECT_LT(side("0.3"), 0.0);
  EXPECT_EQ(side("-0.3"), -side("0.3"));  // Property: the side force is an odd function of the slip angle.
  EXPECT_EQ(side("0"), 0.0);
  call.push_back("1.7");
  const Ran refused = runTalus(call);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--slip-angle"));
}

TEST(WheelCommand, LockedWheelAndDefaultLoadAreSupported) {
  const Ran ran = runTalus({"wheel", "--soil", "sand", "--rover", "mer", "--slip", "-1", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_LT(json["drawbar_pull_N"].get<double>(), 0.0);
  EXPECT_NEAR(json["load_N"].get<double>(), 176.0 * 3.71 / 6.0, 1e-9);
}

TEST(WheelCommand, TyresAndRigidGroundAreSupported) {
  const std::vector<std::string> soft{"wheel", "--json", "--soil", "sand",   "--rover",
                                      "mer",   "--load", "100",    "--slip", "0.2"};
  const auto with = [](std::vector<std::string> call, const std::vector<std::string>& more) {
    call.insert(call.end(), more.begin(), more.end());
    return runTalus(call);
  };
  const auto rigid = nlohmann::json::parse(with(soft, {}).out);
  const auto stiff = nlohmann::json::parse(with(soft, {"--inflation", "1e7"}).out);
  EXPECT_EQ(stiff["mode"], "rigid");
  EXPECT_EQ(stiff["drawbar_pull_N"], rigid["drawbar_pull_N"]) << "stiffer than the ground: the rigid wheel";
  const auto limp = nlohmann::json::parse(with(soft, {"--inflation", "3000", "--carcass", "500"}).out);
  EXPECT_EQ(limp["mode"], "flattened");
  EXPECT_LT(limp["sinkage_m"].get<double>(), rigid["sinkage_m"].get<double>());
  // Closed form (thesis C.11): DP = T/r up to mu_s W, then mu_k W with 0.7 and 0.6.
  const std::vector<std::string> hard{"wheel", "--json", "--hard-ground", "--rover",
                                      "mer",   "--load", "100",           "--torque"};
  const auto grips = nlohmann::json::parse(with(hard, {"2.5"}).out),
             slips = nlohmann::json::parse(with(hard, {"20"}).out);
  EXPECT_FALSE(grips["slips"]);
  EXPECT_NEAR(grips["drawbar_pull_N"].get<double>(), 2.5 / 0.125, 1e-9);
  EXPECT_TRUE(slips["slips"]);
  EXPECT_NEAR(slips["drawbar_pull_N"].get<double>(), 60.0, 1e-9);
  EXPECT_EQ(with({"wheel", "--hard-ground", "--rover", "mer"}, {}).code, 2);
}

TEST(WheelCommand, PageIsSelfContained) {
  const Folder folder;
  const Ran ran = runTalus(
      {"wheel", "--soil", "sand", "--rover", "mer", "--slip", "0.3", "--html", folder / "wheel.html"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string page = fileContent(folder / "wheel.html");
  EXPECT_THAT(page, HasSubstr("Stress along the rim"));
  EXPECT_THAT(page, testing::Not(HasSubstr("http://cdn")));
}

TEST(WheelCommand, ErrorsAreOneLineWithTheirExitCode) {
  struct Case {
    std::vector<std::string> words;
    int code;
    const char* says;
  };
  const Folder folder;
  const std::string soil = folder.write("soil.yaml", "cohesion_pa: 1\n");
  for (const Case& c : std::vector<Case>{
           {{"wheel", "--soil", "snad", "--rover", "mer", "--slip", "0.2"}, 2, "did you mean sand?"},
           {{"wheel", "--soil", soil, "--rover", "mer", "--slip", "0.2"}, 2, ":1: unknown key 'cohesion_pa'"},
           {{"wheel", "--soil", "sand", "--rover", "mer", "--slip", "1.2"},
            2,
            "--slip: 1.2, must be -1 to 1"},
           {{"wheel", "--soil", "sand", "--rover", "mer", "--slip", "0.2", "--load", "-4"},
            2,
            "load_N = -4, must be > 0"},
           {{"wheel", "--soil", "sand", "--rover", "mer", "--slip", "0.2", "--load", "1e9"},
            1,
            "sinks to its axle"},
           {{"wheel", "--soil", "sand", "--slip", "0.2"}, 2, "missing --rover"},
           {{"wheel", "--cases", "/nowhere.csv", "-o", folder / "o.csv"}, 2, "/nowhere.csv"},
           {{"wheel", "--cases", "in.csv"}, 2, "missing -o OUT.csv"}}) {
    const Ran ran = runTalus(c.words);
    EXPECT_EQ(ran.code, c.code) << ran.err;
    EXPECT_THAT(ran.err, StartsWith("talus: "));
    EXPECT_THAT(ran.err, HasSubstr(c.says));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

}  // namespace wheel_command_test
}  // namespace talus::cli
