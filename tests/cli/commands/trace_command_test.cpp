#include <cmath>
#include <regex>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace trace_command_test {

// Rows of four wheels by the forward model with 2 % noise; the load cell of wheel 2 reads 6 N too low.
std::string oneWheelShort() {
  std::string text =
      "run,wheel,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m\n";
  const terramech::Soil soil = terramech::loadSoil("sandy_loam");
  for (int row = 0; row < 120; ++row) {
    const int wheel = row % 4;
    const double load_N = 60.0 + 8.0 * (row % 6), slip = 0.1 + 0.05 * (row % 11);
    const terramech::WheelForces forces =
        equilibrium(soil, {.radius_m = 0.1, .width_m = 0.1}, {.load_N = load_N, .slip = slip});
    const auto off = [row](double phase) { return 1.0 + 0.02 * std::sin(12.9 * row * row + phase); };
    for (const double value :
         {row / 12 + 0.0, wheel + 0.0, load_N, slip, forces.torque_Nm * off(1), forces.sinkage_m * off(2),
          forces.drawbar_pull_N + load_N * (off(3) - 1.0) - (wheel == 2 ? 6.0 : 0.0), 0.1})
      text += std::to_string(value) + ",";
    text += "0.1\n";
  }
  return text;
}

TEST(TraceCommand, EffectOfOneGroupIsAttributedToItsColumn) {
  const Folder folder;
  folder.write("t.csv", oneWheelShort());
  folder.write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  const Ran ran = runTalus({"trace", "t.csv", "--base", "base.yaml", "--json", "--quiet"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto effects = nlohmann::json::parse(ran.out)["effects"];
  ASSERT_EQ(effects.size(), 1u) << ran.out;
  EXPECT_EQ(effects[0]["covariate"], "wheel");
  EXPECT_EQ(effects[0]["only"]["wheel"], "2.000000");
  EXPECT_EQ(effects[0]["channel"], "drawbar_pull_over_load");
}

TEST(TraceCommand, FormulaLacksTheColumnThatWasPlanted) {
  const Folder folder;
  std::string rows = "joules,metres,wet\n";
  for (int row = 0; row < 20; ++row)
    rows += fmt::format("{},{},{}\n", 2.0 * row + 3.0 * (row % 5) + 0.3 * std::sin(12.9 * row * row), row,
                        row % 5);
  folder.write("t.csv", rows);
  const std::vector<std::string> call{"trace", "t.csv", "--formula", "joules = a*metres"};
  EXPECT_THAT(runTalus(call, folder.path()).out, testing::HasSubstr("explained: joules on held-out rows"));
  const Ran ran = runTalus({"trace", "t.csv", "--formula", "joules = a*metres", "--json"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto answer = nlohmann::json::parse(ran.out);
  EXPECT_EQ(answer["effects"][0]["covariate"], "wet");
  EXPECT_NEAR(answer["effects"][0]["parameters"]["slope"].get<double>(), 3.0, 0.3);  // three standard errors
  EXPECT_LT(answer["held_out"]["refined_rmse"]["joules"], 0.4);
  EXPECT_TRUE(answer["held_out"]["noise_floor"]["joules"].is_null());
  EXPECT_EQ(runTalus({"trace", "t.csv", "--formula", "joules = a*b*metres"}, folder.path()).code, 2);
}

// The page shows verdict, errors before and after, measured and predicted values, and a plot of each effect.
TEST(TraceCommand, PageShowsVerdictErrorsAndEachEffectWithItsData) {
  const Folder folder;
  folder.write("t.csv", oneWheelShort());
  folder.write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  const Ran ran = runTalus({"trace", "t.csv", "--base", "base.yaml", "--html", "r.html"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string page = fileContent(folder / "r.html");
  std::size_t last = 0;
  for (const char* part : {"explained by 1 effect", "label=\"drawbar_pull_over_load over slip\"",
                           "load_cell_tilt: drawbar_pull_over_load",
                           "<p>load_cell_tilt in drawbar_pull_over_load", "<th>rmse of the fit</th>"}) {
    const std::size_t at = page.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    EXPECT_GT(at, last) << part;
    last = at;
  }
  const std::regex size(R"(\n    (\w+ = \S+) \+- (\S+) \[)");
  int sizes = 0;
  for (std::sregex_iterator found(ran.out.begin(), ran.out.end(), size), end; found != end; ++found, ++sizes)
    EXPECT_THAT(page, testing::HasSubstr((*found)[1].str() + " +- " + (*found)[2].str()));
  EXPECT_GT(sizes, 0) << ran.out;
}

// Regression: rows with a side force but without slip angle were traced as rows of unsteered wheels.
TEST(TraceCommand, SideForcesWithoutSlipAngleAreRejected) {
  const Folder folder;
  std::string text = "load_N,slip,sinkage_m,drawbar_pull_N,side_force_N,wheel_radius_m,wheel_width_m\n";
  for (int row = 0; row < 12; ++row)
    text += "80," + std::to_string(0.1 + 0.05 * row) + ",0.01,5," + std::to_string(10 + row) + ",0.1,0.1\n";
  folder.write("t.csv", text);
  const Ran ran = runTalus({"trace", "t.csv"}, folder.path());
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err,
              testing::HasSubstr("t.csv:2: no usable row: side_force_N = 10 without slip_angle_rad"));
}

TEST(TraceCommand, HeldOutRunWritesNoPageAndNoModel) {
  const Folder folder;
  folder.write("t.csv", oneWheelShort());
  for (const std::string option : {"--html", "--model-out"}) {
    const Ran refused =
        runTalus({"trace", "t.csv", "--hold-out", "slip=0.5..1", option, "out"}, folder.path());
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, testing::AllOf(testing::HasSubstr(option), testing::HasSubstr("--hold-out")));
  }
}

TEST(TraceCommand, EqualCausesAreDistinctAndListedOnce) {
  const Folder folder;
  std::string table =
      "run,pass_index,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m\n";
  terramech::Soil soil = terramech::loadSoil("sandy_loam");
  const terramech::Soil fresh = soil;
  for (int row = 0; row < 120; ++row) {
    const int pass = 1 + row % 3;
    const double load_N = 60.0 + 8.0 * (row % 5), slip = 0.1 + 0.05 * (row % 11);
    soil.frictional_modulus = fresh.frictional_modulus * (2.5 - 1.5 * std::exp(1.0 - pass));
    soil.cohesive_modulus = fresh.cohesive_modulus * (2.5 - 1.5 * std::exp(1.0 - pass));
    const terramech::WheelForces forces =
        equilibrium(soil, {.radius_m = 0.1, .width_m = 0.1}, {.load_N = load_N, .slip = slip});
    const auto off = [row](double phase) { return 1.0 + 0.02 * std::sin(12.9 * row * row + phase); };
    for (const double value :
         {row / 12 + 0.0, pass + 0.0, load_N, slip, forces.torque_Nm * off(1), forces.sinkage_m * off(2),
          forces.drawbar_pull_N + load_N * (off(3) - 1.0), 0.1})
      table += std::to_string(value) + ",";
    table += "0.1\n";
  }
  folder.write("t.csv", table);
  folder.write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  const Ran ran = runTalus({"trace", "t.csv", "--base", "base.yaml", "--json", "--quiet"}, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto effects = nlohmann::json::parse(ran.out)["effects"];
  ASSERT_FALSE(effects.empty());
  EXPECT_EQ(effects[0]["covariate"], "pass_index");
  EXPECT_EQ(effects[0]["family"], "multipass");
  for (const auto& effect : effects) {
    std::set<std::string> named{effect["name"].get<std::string>() + effect["covariate"].get<std::string>()};
    for (const auto& other : effect["equal_to"]) {
      const std::string one = other["name"].get<std::string>() + other["covariate"].get<std::string>();
      EXPECT_TRUE(named.insert(one).second) << one;
    }
  }
}

/// 90 rows in which the column `dust` reduces the drawbar pull; the column `humid` is a linear function of
/// `dust`.
std::string tiedTable() {
  std::string table = "run,load_N,slip,dust,humid,torque_Nm,sinkage_m,drawbar_pull_N\n";
  const terramech::Soil soil = terramech::loadSoil("sandy_loam");
  for (int row = 0; row < 90; ++row) {
    const double load_N = 60.0 + 8.0 * (row % 5), slip = 0.1 + 0.05 * (row % 11), dust = 0.1 * (row * 7 % 11);
    const terramech::WheelForces forces =
        equilibrium(soil, {.radius_m = 0.1, .width_m = 0.1}, {.load_N = load_N, .slip = slip});
    const auto off = [row](double phase) { return 1.0 + 0.02 * std::sin(12.9 * row * row + phase); };
    table += fmt::format("r{},{},{},{},{},{},{},{}\n", row / 6, load_N, slip, dust, 3.0 + 2.0 * dust,
                         forces.torque_Nm * off(1), forces.sinkage_m * off(2),
                         forces.drawbar_pull_N + load_N * (off(3) - 1.0 - 0.08 * dust));
  }
  return table;
}

TEST(TraceCommand, ProposedRunsAreScoredOnceMeasured) {
  const Folder folder;
  folder.write("t.csv", tiedTable());
  folder.write("base.yaml", "{soil: sandy_loam, model: wong-reece, wheel: {radius_m: 0.1, width_m: 0.1}}\n");
  const auto trace = [&](std::vector<std::string> more) {
    std::vector<std::string> call{"trace", "t.csv", "--base", "base.yaml", "--json", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    return runTalus(call, folder.path());
  };
  const Ran proposed = trace({"--propose", "2", "-o", "next.csv"});
  ASSERT_EQ(proposed.code, 0) << proposed.err;
  const auto proposals = nlohmann::json::parse(proposed.out)["proposals"];
  ASSERT_EQ(proposals.size(), 2U);
  ASSERT_GE(proposals[0]["predictions"].size(), 2U);
  const auto &a = proposals[0]["predictions"][0], &b = proposals[0]["predictions"][1];
  EXPECT_GT(std::abs(a["drawbar_pull_N"].get<double>() - b["drawbar_pull_N"].get<double>()),
            3.0 * a["std"].get<double>());
  // Synthetic measurements that agree with the prediction of the second cause.
  const terramech::Telemetry next = terramech::readTelemetry((folder.path() / "next.csv").string());
  std::string measured = "run,load_N,slip,dust,humid,drawbar_pull_N\n";
  for (std::size_t row = 0; row < next.size(); ++row)
    measured +=
        fmt::format("next,{},{},{},{},{}\n", next.at("load_N")[row], next.at("slip")[row],
                    next.at("dust")[row], next.at("humid")[row], next.at("predicted_2_drawbar_pull_N")[row]);
  folder.write("measured.csv", measured);
  const Ran ran = trace({"--score", "measured.csv"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto scores = nlohmann::json::parse(ran.out)["scores"];
  ASSERT_EQ(scores.size(), proposals[0]["predictions"].size());
  EXPECT_EQ(scores[1]["cause"], b["cause"]);
  EXPECT_GT(scores[1]["probability"].get<double>(), 0.5);
  EXPECT_LT(scores[0]["probability"].get<double>(), 0.01);
}

}  // namespace trace_command_test
}  // namespace talus::cli
