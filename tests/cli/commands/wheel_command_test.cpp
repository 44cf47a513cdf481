#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace wheel_command_test {

using testing::HasSubstr;

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

}  // namespace wheel_command_test
}  // namespace talus::cli
