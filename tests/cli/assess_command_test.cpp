#include <cmath>

#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kDrive =
    "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n"
    "80,0.8,0.02,0.5,0.1,0.1\n"   // T/rW 0.1, z/r 0.2
    "80,2.4,0.04,0.5,0.1,0.1\n"   // T/rW 0.3, z/r 0.4
    "80,4.8,0.01,0.5,0.1,0.1\n";  // T/rW 0.6, z/r 0.1

json assessed(const std::vector<std::string>& more) {
  const Folder folder;
  std::vector<std::string> call{"--json", "assess", folder.write("drive.csv", kDrive)};
  call.insert(call.end(), more.begin(), more.end());
  const Ran ran = runTalus(call);
  EXPECT_EQ(ran.code, 0) << ran.err;
  return json::parse(ran.out);
}

TEST(AssessCommand, PrintsTheFieldsThatOthersRelyOn) {
  const json rows = assessed({});
  ASSERT_EQ(rows.size(), 3u);
  for (const json& row : rows) {
    for (const char* field : {"row", "drawbar_pull_over_load", "std", "sinkage_over_radius"})
      EXPECT_TRUE(row.at(field).is_number()) << field;
    const auto& p = row["probability"];
    EXPECT_NEAR(p["safe"].get<double>() + p["marginal"].get<double>() + p["dangerous"].get<double>(), 1.0,
                1e-9);
  }
  EXPECT_EQ(rows[0]["row"], 1);
  EXPECT_EQ(rows[0]["category"], "dangerous");
  EXPECT_EQ(rows[2]["category"], "safe");
}

TEST(AssessCommand, PlaneFormulaIsEquation321AndBothPrintedPairsAreDangerous) {
  // Printed in: thesis 3.5, pairs (0.1, 0.2) and (0.3, 0.4) at 10 deg; it calls the second safe, which
  // Eq. 3.21 does not give: -0.2 for both.
  const json rows = assessed({"--formula", "plane"});
  for (int k : {0, 1}) {
    EXPECT_NEAR(rows[static_cast<std::size_t>(k)]["drawbar_pull_over_load"].get<double>(), -0.2, 1e-12);
    EXPECT_EQ(rows[static_cast<std::size_t>(k)]["category"], "dangerous");
  }
}

TEST(AssessCommand, ASteeperMissionAsksForMore) {
  EXPECT_EQ(assessed({"--slope", "0.6"})[2]["category"], "dangerous");
}

TEST(AssessCommand, MistakesAreOneLineWithTheirExitCode) {
  const Folder folder;
  const std::string bad =
      folder.write("bad.csv", "load_N,torque_Nm,sinkage_m,wheel_radius_m,wheel_width_m\n0,1,0.01,0.1,0.1\n");
  const std::string nowheel = folder.write("nowheel.csv", "load_N,torque_Nm,sinkage_m\n80,1,0.01\n");
  for (const auto& [words, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"assess", bad}, "load_N"},
           {{"assess", nowheel}, "--rover"},
           {{"assess", folder.write("ok.csv", kDrive), "--slope", "2"}, "slope"}}) {
    const Ran ran = runTalus(words);
    EXPECT_EQ(ran.code, 2) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(says));
  }
}

}  // namespace
}  // namespace talus::cli
