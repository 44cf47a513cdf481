// From residual to route: `talus trace` refines a model, and planning subcommands use the refined model.
#include <cmath>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace refined_model_test {

constexpr const char* kSoil =
    "soil: {name: site sand, cohesion_Pa: 600, friction_angle_rad: 0.6, sinkage_exponent: 1.0, "
    "cohesive_modulus: 0, "
    "frictional_modulus: 1.0e6, shear_modulus_m: 0.015, c1: 0.43, c2: 0.32, density_kg_m3: 1600}\n";

double hills(int column, int row) {
  return 0.2 * std::sin(0.17 * column) + 0.17 * std::cos(0.14 * row);
}

class RefinedModelCommands : public ::testing::Test {
 protected:
  RefinedModelCommands() {
    folder_.write("dem.asc", asciiGrid(60, 60, hills));
    folder_.write("soil.yaml", kSoil);
  }

  Ran talus(std::vector<std::string> words) const {
    words.emplace_back("--quiet");
    return runTalus(words, folder_.path());
  }

  Folder folder_;
};

TEST_F(RefinedModelCommands, PlanAndCostmapApplyAndStoreAModel) {
  folder_.write("model.yaml",
                std::string(kSoil) + "model: wong-reece\neffects: [{name: bulldozing, parameters: [0.4]}]\n");
  const auto energy = [&](const std::vector<std::string>& ground) {
    const Ran ran = talus(joined({"plan", "dem.asc", "--resolution", "1", "--start", "5,5", "--goal", "54,50",
                                  "--json", "-o", "r.geojson"},
                                 ground));
    EXPECT_EQ(ran.code, 0) << ran.err;
    return nlohmann::json::parse(ran.out, nullptr, false)["energy_J"].get<double>();
  };
  const double plain = energy({"--rover", "fido", "--soil", "soil.yaml"});
  const double refined = energy({"--rover", "fido", "--model", "model.yaml"});
  EXPECT_GT(refined, 1.02 * plain);  // Property: pushing soil costs energy
  ASSERT_EQ(talus({"costmap", "dem.asc", "--resolution", "1", "--rover", "fido", "--model", "model.yaml",
                   "-o", "map.ot"})
                .code,
            0);
  EXPECT_NEAR(energy({"--map", "map.ot"}), refined, 1e-6 * refined);
  const Ran why = talus({"explain", "dem.asc", "--resolution", "1", "--rover", "fido", "--model",
                         "model.yaml", "--at", "20,20"});
  EXPECT_NE(why.out.find("bulldozing"), std::string::npos);
}

// A simulated drive over the hills with effects unknown to the rover; `ground` are the options of its soil.
std::vector<std::string> simulatedTraverse(const std::vector<std::string>& ground) {
  return joined({"drive", "dem.asc", "--resolution", "1", "--rover", "fido", "--truth", "truth.yaml",
                 "--start", "5,5", "--goal", "40,40", "--belief", "prior", "--json"},
                ground);
}

TEST_F(RefinedModelCommands, TracedEffectImprovesPredictionOfTheNextTraverse) {
  folder_.write("base.yaml", std::string(kSoil) + "model: wong-reece\nsensors: {slip: 0.02}\n");
  // Without the second slip, whose speed is a function of slip at one rim speed.
  folder_.write("truth.yaml",
                "second_slip: false\neffects: [{name: slip_sinkage_ding, parameters: [0.3]}]\n");
  // Without the effect in its model the rover may fail (exit code 1), but telemetry up to there is written.
  const auto errors = [&](const std::vector<std::string>& ground) {
    const Ran ran = talus(simulatedTraverse(ground));
    EXPECT_LE(ran.code, ground.front() == "--model" ? 0 : 1) << ran.err;
    return nlohmann::json::parse(ran.out, nullptr, false)["prediction"];
  };
  const auto before = errors({"--soil", "soil.yaml", "--telemetry", "t.csv"});
  const Ran traced =
      talus({"trace", "t.csv", "--base", "base.yaml", "--rover", "fido", "--json", "--model-out", "m.yaml"});
  ASSERT_EQ(traced.code, 0) << traced.err;
  const auto effects = nlohmann::json::parse(traced.out)["effects"];
  ASSERT_EQ(effects.size(), 1u) << traced.out;
  EXPECT_EQ(effects[0]["family"], "slip_sinkage");
  const auto after = errors({"--model", "m.yaml"});
  // Property: the model traced on one traverse reduces the prediction errors of the next traverse.
  EXPECT_LT(after["slip_rmse"].get<double>(), before["slip_rmse"].get<double>());
  EXPECT_LT(after["energy_rmse"].get<double>(), 0.9 * before["energy_rmse"].get<double>());
  EXPECT_LT(std::abs(after["energy_error"].get<double>()), 0.03);
  // An effect stated in the base model is kept, whichever effects are found.
  folder_.write("stated.yaml", std::string(kSoil) +
                                   "model: wong-reece\nsensors: {slip: 0.02}\n"
                                   "effects: [{name: bulldozing, parameters: [0.05]}]\n");
  const Ran again = talus(
      {"trace", "t.csv", "--base", "stated.yaml", "--rover", "fido", "--json", "--model-out", "again.yaml"});
  ASSERT_EQ(again.code, 0) << again.err;
  const auto found = nlohmann::json::parse(again.out)["effects"];
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0]["family"], "slip_sinkage") << again.out;
  const std::string model = fileContent(folder_ / "again.yaml");
  for (const char* name : {"name: multipass_reload", "name: bulldozing", "name: slip_sinkage"})
    EXPECT_NE(model.find(name), std::string::npos) << name;
}

TEST_F(RefinedModelCommands, TraverseOnMatchingGroundYieldsNoEffect) {
  folder_.write("base.yaml", std::string(kSoil) + "model: wong-reece\nsensors: {slip: 0.02}\n");
  folder_.write("truth.yaml", "{}\n");
  ASSERT_EQ(talus(simulatedTraverse({"--soil", "soil.yaml", "--telemetry", "t.csv"})).code, 0);
  const Ran traced = talus({"trace", "t.csv", "--base", "base.yaml", "--rover", "fido", "--json"});
  ASSERT_EQ(traced.code, 0) << traced.err;
  EXPECT_TRUE(nlohmann::json::parse(traced.out)["effects"].empty()) << traced.out;
}

TEST_F(RefinedModelCommands, ModelsThatCannotPlanAreRejected) {
  folder_.write("linear.yaml", std::string(kSoil) + "model: linear-formula\n");
  folder_.write("nosoil.yaml", "model: wong-reece\n");
  for (const char* model : {"linear.yaml", "nosoil.yaml", "missing.yaml"}) {
    const Ran ran = talus({"plan", "dem.asc", "--resolution", "1", "--start", "5,5", "--goal", "9,9",
                           "--rover", "fido", "--model", model, "-o", "r.geojson"});
    EXPECT_EQ(ran.code, 2) << model;
    EXPECT_NE(ran.err.find(model), std::string::npos) << ran.err;
  }
  EXPECT_EQ(talus({"plan", "dem.asc", "--resolution", "1", "--start", "5,5", "--goal", "9,9", "--model",
                   "linear.yaml", "--soil", "soil.yaml", "-o", "r.geojson"})
                .code,
            2);
}

}  // namespace refined_model_test
}  // namespace talus::cli
