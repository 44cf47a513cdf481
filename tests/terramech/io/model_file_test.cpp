#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <talus/talus.hpp>
#include <talus/terramech/io/model_file.hpp>

namespace talus::terramech {
namespace {

using testing::HasSubstr;

std::string written(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("talus_" + std::to_string(::getpid()) + name);
  std::ofstream(path) << text;
  return path.string();
}

RefinedModel refined() {
  RefinedModel model;
  model.soil = {.name = "a \"quoted\" sand",
                .cohesion_Pa = 812.5,
                .friction_angle_rad = 0.55,
                .sinkage_exponent = 1.1,
                .cohesive_modulus = 900.0,
                .frictional_modulus = 1.5e6};
  Effect effect;
  effect.name = "slip_sinkage_ding";
  effect.covariate = "slip";
  effect.channel = Channel::Sinkage;
  effect.parameters = {1.0 / 3.0};
  Effect curve;
  curve.name = "empirical";
  curve.covariate = "dust";
  curve.parameters = {0.0, 0.1, -0.05};
  curve.knots = {0.0, 1.0, 2.5};
  curve.only_column = "source";
  curve.only_value = "b";
  model.effects = {effect, curve};
  model.noise.slip_relative = 0.03;
  model.fitted = {{0, 0}};
  model.covariance = {1e-4};
  return model;
}

TEST(ModelFile, ReadsBackToTheSameBits) {
  const auto path = written("model.yaml", modelText(refined()));
  const RefinedModel back = loadModel(path).model;
  EXPECT_EQ(modelText(back), modelText(refined()));
  EXPECT_EQ(back.effects[0].parameters, refined().effects[0].parameters);
  EXPECT_EQ(back.effects[1].knots, refined().effects[1].knots);
  std::filesystem::remove(path);
}

TEST(ModelFile, TrainedRangesAreReadBack) {
  const TrainedRange slip{
      .column = "slip", .low = -0.5, .high = 1.0 / 3.0, .below = {0.1, 0, 0, 0}, .above = {0, 0.2, 0, 0}};
  const auto path = written("trained.yaml", modelText(refined(), {.trained = {slip}}));
  const ModelFile back = loadModel(path);
  ASSERT_EQ(back.scope.trained.size(), 1U);
  EXPECT_EQ(back.scope.trained[0].high, slip.high);
  EXPECT_EQ(back.scope.trained[0].above, slip.above);
  // Closed form: 0.5 below -0.5 at 0.1 a unit; nothing inside.
  EXPECT_DOUBLE_EQ(back.scope.trained[0].stdAt(-1.0, 0), 0.05);
  EXPECT_EQ(back.scope.trained[0].stdAt(0.0, 0), 0.0);
  std::filesystem::remove(path);
}

TEST(ModelFile, RefusesWhatItCannotMean) {
  const std::pair<const char*, const char*> bad[] = {
      {"model: wong-rece\nsoil: sand\n", "no model 'wong-rece'"},
      {"soil: sand\neffects:\n  - {name: slip_sinkage_dang, covariate: slip, channel: sinkage_over_radius, "
       "parameters: [1]}\n",
       "did you mean slip_sinkage_ding?"},
      {"soil: sand\neffects:\n  - {name: slip_sinkage_ding, covariate: slip, channel: sinkage_over_radius, "
       "parameters: [1, 2]}\n",
       "needs 1 numbers"},
      {"soil: sand\nsensors: {slip: -1}\n", "standard deviation"},
      {"soil: sand\ntrained:\n  - {column: slip, range: [1, 0], below: [0, 0, 0, 0], above: [0, 0, 0, 0]}\n",
       "low <= high"},
      {"soil: sand\neffects:\n  - {name: slip_sinkage_ding, parameters: [1], knots: [0.5, 0.1]}\n",
       "low <= high"},
  };
  for (const auto& [text, reason] : bad) {
    const auto path = written("bad.yaml", text);
    try {
      loadModel(path);
      ADD_FAILURE() << text;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(reason));
    }
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace talus::terramech
