#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {
namespace model_file_test {

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

// Property: a parameter or variance below the file's minimum is written and read as 0.
TEST(ModelFile, NumbersBelowTheFileMinimumAreWrittenAsZero) {
  RefinedModel model = refined();
  model.effects[0].parameters = {1.6e-115};
  model.fitted = {{0, 0}, {1, 0}};
  model.covariance = {1e-230, 1e-116, 1e-116, 0.04};
  const RefinedModel back = loadModel(written("tiny.yaml", modelText(model))).model;
  EXPECT_EQ(back.effects[0].parameters, std::vector<double>{0.0});
  EXPECT_EQ(back.covariance, (std::vector<double>{0.0, 0.0, 0.0, 0.04}));
}

// Property: the variance of a modulus of 1e9 Pa/m is read back.
TEST(ModelFile, VarianceOfALargeModulusIsReadBack) {
  RefinedModel model = refined();
  model.fitted = {{0, 0}, {1, 0}};
  model.covariance = {4.9e17, 0.0, 0.0, 0.04};
  EXPECT_EQ(loadModel(written("large.yaml", modelText(model))).model.covariance, model.covariance);
}

TEST(ModelFile, RoundTripIsExact) {
  const auto path = written("model.yaml", modelText(refined()));
  const RefinedModel back = loadModel(path).model;
  EXPECT_EQ(modelText(back), modelText(refined()));
  EXPECT_EQ(back.effects[0].parameters, refined().effects[0].parameters);
  EXPECT_EQ(back.effects[1].knots, refined().effects[1].knots);
  std::filesystem::remove(path);
}

TEST(ModelFile, TrainedRangesRoundTrip) {
  const TrainedRange slip{
      .column = "slip", .low = -0.5, .high = 1.0 / 3.0, .below = {0.1, 0, 0, 0}, .above = {0, 0.2, 0, 0}};
  const auto path = written("trained.yaml", modelText(refined(), {.trained = {slip}}));
  const ModelFile back = loadModel(path);
  ASSERT_EQ(back.scope.trained.size(), 1U);
  EXPECT_EQ(back.scope.trained[0].high, slip.high);
  EXPECT_EQ(back.scope.trained[0].above, slip.above);
  // Closed form: 0.5 below -0.5 at 0.1 per unit; 0 inside the range.
  EXPECT_DOUBLE_EQ(back.scope.trained[0].stdAt(-1.0, 0), 0.05);
  EXPECT_EQ(back.scope.trained[0].stdAt(0.0, 0), 0.0);
  std::filesystem::remove(path);
}

TEST(ModelFile, InvalidModelsAreRejected) {
  const std::pair<const char*, const char*> bad[] = {
      {"model: wong-rece\nsoil: sand\n", "no model 'wong-rece'"},
      {"soil: sand\neffects:\n  - {name: slip_sinkage_dang, covariate: slip, channel: sinkage_over_radius, "
       "parameters: [1]}\n",
       "did you mean slip_sinkage_ding?"},
      {"soil: sand\neffects:\n  - {name: slip_sinkage_ding, covariate: slip, channel: sinkage_over_radius, "
       "parameters: [1, 2]}\n",
       "effect 'slip_sinkage_ding' has 2 parameters, must have 1; write parameters"},
      {"soil: sand\neffects:\n  - {name: zz, parameters: [1]}\n", "no effect 'zz'; name one of "},
      {"soil: sand\nfitted:\n  - {effect: 3, index: 9}\ncovariance: [1]\n",
       "effect 3, index 9 names no fitted parameter of this model; fit it once more"},
      {"soil: sand\nsensors: {slip: -1}\n", "slip must be a standard deviation >= 0; correct the value"},
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

std::string faultOf(const std::string& yaml) {
  const auto path = written("faulty.yaml", yaml);
  try {
    loadModel(path);
  } catch (const InputError& e) {
    std::filesystem::remove(path);
    return e.what();
  }
  std::filesystem::remove(path);
  return "no error";
}

// Property: an invalid covariance, which would be read as standard deviation 0, is rejected; the error states
// the line number of the covariance.
TEST(ModelFile, InvalidCovarianceIsRejected) {
  const auto fault = [](const std::string& covariance) {
    return faultOf("soil: sand\nfitted: [{effect: -1, index: 0}, {effect: -1, index: 1}]\ncovariance: [" +
                   covariance + "]\n");
  };
  EXPECT_EQ(fault("1e4, 0.5, 0.5, 1e-3"), "no error");
  EXPECT_EQ(fault("0, 0, 0, 1e-3"), "no error");
  EXPECT_THAT(fault("-1e4, 0, 0, 1e-3"), HasSubstr(":3: covariance has the negative variance -10000"));
  EXPECT_THAT(fault("1e4, 0, 0, -1e-3"), HasSubstr("negative variance"));
  EXPECT_THAT(fault("1e4, 0.5, 0.4, 1e-3"), HasSubstr("is not symmetric in row 1"));
  EXPECT_THAT(fault("1e4, 4, 4, 1e-3"), HasSubstr("correlation beyond 1"));
  EXPECT_THAT(fault("0, 4, 4, 1e-3"), HasSubstr("correlation beyond 1"));
  // Any two of the three correlations are possible together, but not all three.
  EXPECT_THAT(
      faultOf("soil: sand\nfitted: [{effect: -1, index: 0}, {effect: -1, index: 1}, {effect: -1, index: 2}]\n"
              "covariance: [1, 0.9, 0.9, 0.9, 1, -0.9, 0.9, -0.9, 1]\n"),
      HasSubstr("not positive semidefinite"));
}

TEST(ModelFile, DuplicatesAndOutOfRangeValuesAreRejected) {
  EXPECT_THAT(faultOf("soil: sand\nnoise: {slip: -0.1}\n"),
              HasSubstr(":2: slip must be a standard deviation >= 0"));
  EXPECT_THAT(faultOf("soil: sand\nnoise: {torque_relative: -0.1}\n"),
              HasSubstr("torque_relative must be a standard deviation >= 0"));
  EXPECT_THAT(faultOf("soil: sand\nfitted:\n  - {effect: -1, index: 0}\n  - {effect: -1, index: 0}\n"
                      "covariance: [1, 0, 0, 1]\n"),
              HasSubstr(":4: names a parameter of `fitted` a second time"));
  const std::string range = "  - {column: slip, range: [0, 1], below: [0, 0, 0, 0], above: [0, 0, 0, 0]}\n";
  EXPECT_THAT(faultOf("soil: sand\ntrained:\n" + range + range),
              HasSubstr(":4: column 'slip' is trained a second time"));
  EXPECT_THAT(faultOf("soil: sand\neffects:\n  - {name: slip_sinkage_ding, parameters: [-5]}\n"),
              HasSubstr(":3: slip_sinkage_ding: "));
}

}  // namespace model_file_test
}  // namespace talus::terramech
