#include <cmath>

#include <talus/common/input_error.hpp>
#include <talus/terramech/calibration/tables/model_estimate.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "calibration/wheel_table.hpp"

namespace talus::terramech {
namespace model_estimate_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kEffect =
    "effects:\n  - {name: slip_sinkage_linear, covariate: slip, channel: sinkage_over_radius, parameters: "
    "[0.8]}\n";

// Rows of the synthetic soil under a wheel that digs; with `sunk` one additional row beyond the axle.
std::string diggingRows(bool sunk = false) {
  RefinedModel model;
  model.soil = kMadeSoil;
  model.effects = {
      {.name = "slip_sinkage_linear", .covariate = "slip", .channel = Channel::Sinkage, .parameters = {0.8}}};
  std::string text = kWheelHead + ",drawbar_pull_N\n";
  for (int k = 0; k < 24; ++k) {
    const WheelState s{.wheel = kMadeWheel, .load_N = 100.0 + 10.0 * (k % 5), .slip = 0.05 + 0.03 * k};
    const Reading r = predict(model, s);
    text += wheelLine({s.load_N, r.torque_Nm, r.sinkage_m, s.slip}, kMadeWheel) + "," +
            std::to_string(r.drawbar_pull_N) + "\n";
  }
  if (sunk) text += wheelLine({100.0, 5.0, 0.16, 0.5}, kMadeWheel) + ",1\n";
  return text;
}

SoilEstimate estimate(const std::string& rows, const std::string& model_text, EstimateOptions options = {}) {
  const test::TemporaryFile table{rows}, model{model_text, ".yaml"};
  options.table = table.path();
  options.model = model.path();
  if (options.method.empty()) options.method = "wong-reece";
  return modelEstimate(options, {});
}

TEST(ModelEstimate, RecoversTheSoilUnderKnownEffects) {
  const SoilEstimate found = estimate(diggingRows(), "soil: sand\n" + kEffect, {.noise = 0.01});
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 3.0 * std::sqrt(found.covariance(0, 0)));
  EXPECT_NEAR(found.tan_friction, std::tan(0.45), 3.0 * std::sqrt(found.covariance(1, 1)));
  EXPECT_LT(std::sqrt(found.covariance(1, 1)), 0.1);
  EXPECT_THAT(found.effects, testing::ElementsAre("slip_sinkage_linear"));
  EXPECT_EQ(found.rows_used, 24U);
}

TEST(ModelEstimate, RowsBeyondTheAxleAreExcludedWithAWarning) {
  const SoilEstimate found = estimate(diggingRows(true), "soil: sand\n" + kEffect);
  EXPECT_EQ(found.rows_used, 24U);
  EXPECT_THAT(found.warnings, testing::Contains(HasSubstr("1 rows with sinkage at or above the axle")));
  const std::string sunk = kWheelHead + "\n" + wheelLine({100.0, 5.0, 0.16, 0.5}, kMadeWheel) + "\n";
  EXPECT_THAT([&] { estimate(sunk, "soil: sand\n"); },
              ThrowsMessage<InputError>(HasSubstr("in every row the sinkage reaches the axle")));
}

TEST(ModelEstimate, IncompatibleOptionsAreRejected) {
  const std::string soil = "soil: sand\n";
  EXPECT_THAT([&] { estimate(diggingRows(), soil, {.method = "iagnemma"}); },
              ThrowsMessage<InputError>(HasSubstr("use --method wong-reece")));
  EXPECT_THAT([&] { estimate(diggingRows(), soil, {.recursive = true}); },
              ThrowsMessage<InputError>(HasSubstr("--recursive: cannot be combined with --model")));
  EXPECT_THAT([&] { estimate(diggingRows(), "model: linear-formula\nsoil: sand\n"); },
              ThrowsMessage<InputError>(HasSubstr("linear-formula, which has no soil")));
  const test::TemporaryFile exact{
      "{cohesion_Pa: 1000, friction_angle_rad: 0.5, sinkage_exponent: 1.0, cohesive_modulus: 0, "
      "frictional_modulus: 1.0e6, shear_modulus_m: 0.02}\n",
      ".yaml"};
  EXPECT_THAT([&] { estimate(diggingRows(), soil, {.prior = exact.path()}); },
              ThrowsMessage<InputError>(HasSubstr("no parameter is free")));
}

}  // namespace model_estimate_test
}  // namespace talus::terramech
