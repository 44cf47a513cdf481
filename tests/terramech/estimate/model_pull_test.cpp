#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/model_pull.hpp>

namespace talus::terramech {

namespace model_pull_test {

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};
const WheelState kState{.wheel = kWheel, .load_N = 80.0, .slip = 0.3};

RefinedModel sandModel() {
  RefinedModel model;
  model.soil = {.name = "sand",
                .cohesion_Pa = 500.0,
                .friction_angle_rad = 0.56,
                .sinkage_exponent = 0.9,
                .frictional_modulus = 1.7e6,
                .shear_modulus_m = 0.015};
  return model;
}

Effect effect(const char* name, std::vector<double> parameters, const char* covariate = "constant") {
  Effect e;
  e.name = name;
  e.covariate = covariate;
  e.parameters = std::move(parameters);
  return e;
}

TEST(ModelPull, PullOnPlainSoilEqualsTheEquilibrium) {
  const ModelPull pull = pullOf(groundTruthOf(sandModel()), kState);
  const WheelForces f = equilibrium(sandModel().soil, kWheel, {.load_N = 80.0, .slip = 0.3});
  EXPECT_NEAR(pull.pull_over_load.value, f.drawbar_pull_N / 80.0, 1e-6);
  EXPECT_NEAR(pull.sinkage_over_radius.value, f.sinkage_m / 0.1, 1e-6);
  EXPECT_NEAR(pull.torque_over_load_radius, f.torque_Nm / 8.0, 1e-6);
  EXPECT_DOUBLE_EQ(pull.pull_over_load.std, 0.0);
}

TEST(ModelPull, ExcludesSensorEffects) {
  // Property: an offset of the load cell changes predict() and not the pull; an effect on the soil changes
  // both.
  const double plain = pullOf(groundTruthOf(sandModel()), kState).pull_over_load.value;
  RefinedModel tilted = sandModel();
  tilted.effects = {effect("load_cell_tilt", {0.1})};
  ASSERT_GT(predict(tilted, kState).scaled(Channel::DrawbarPull), plain + 0.05);
  EXPECT_DOUBLE_EQ(pullOf(groundTruthOf(tilted), kState).pull_over_load.value, plain);
  RefinedModel sinking = sandModel();
  sinking.effects = {effect("slip_sinkage_ding", {1.0}, "slip")};
  EXPECT_LT(pullOf(groundTruthOf(sinking), kState).pull_over_load.value, plain - 0.005);
}

TEST(ModelPull, KeepsTheCovarianceOfGroundEffects) {
  // Property: the standard deviation is that of the same model without the sensor's effect and its column.
  RefinedModel both = sandModel();
  both.effects = {effect("load_cell_tilt", {0.1}), effect("slip_sinkage_ding", {1.0}, "slip")};
  both.fitted = {{0, 0}, {1, 0}, {-1, 0}};
  both.covariance = {4e-4, 1e-3, 0.1, 1e-3, 0.04, 0.2, 0.1, 0.2, 1e4};
  both.noise.absolute[0] = 3.0;
  RefinedModel one = sandModel();
  one.effects = {effect("slip_sinkage_ding", {1.0}, "slip")};
  one.fitted = {{0, 0}, {-1, 0}};
  one.covariance = {0.04, 0.2, 0.2, 1e4};
  const double std = pullOf(groundTruthOf(both), kState).pull_over_load.std;
  EXPECT_GT(std, 0.001);
  EXPECT_DOUBLE_EQ(std, predictWithStd(one, kState).scaled_std[0]);
}

TEST(ModelPull, StdPropagatesSoilUncertainty) {
  // Property: the standard deviation of one parameter gives half the difference of the pull at plus and
  // minus that deviation.
  RefinedModel model = sandModel();
  model.soil_prior_std = {{"friction_angle_rad", 0.02}};
  const auto at = [&](double phi) {
    RefinedModel moved = sandModel();
    moved.soil.friction_angle_rad = phi;
    return predict(moved, kState).scaled(Channel::DrawbarPull);
  };
  const double half = 0.5 * (at(0.58) - at(0.54));
  ASSERT_GT(half, 0.01);
  EXPECT_NEAR(pullOf(groundTruthOf(model), kState).pull_over_load.std / half, 1.0, 0.02);
}

TEST(ModelPull, StdPropagatesSlipAndLoadErrors) {
  // Property: half the difference of the pull over twice the stated standard deviation of the reading.
  const auto pull = [](double load_N, double slip) {
    const WheelState state{.wheel = kWheel, .load_N = load_N, .slip = slip};
    return predict(sandModel(), state).drawbar_pull_N / 80.0;  // over the load as read
  };
  RefinedModel model = sandModel();
  model.stated.slip = 0.02;
  EXPECT_NEAR(
      pullOf(groundTruthOf(model), kState).pull_over_load.std / (0.5 * (pull(80.0, 0.32) - pull(80.0, 0.28))),
      1.0, 0.02);
  model.stated = {.load_N = 4.0};
  EXPECT_NEAR(pullOf(groundTruthOf(model), kState).pull_over_load.std /
                  (0.5 * std::abs(pull(84.0, 0.3) - pull(76.0, 0.3))),
              1.0, 0.02);
}

TEST(ModelPull, ForecastsReferenceSlipAndMaximumPull) {
  RefinedModel model = sandModel();
  model.noise.slip_absolute = 0.1;  // the slip of the forecast is given, not measured
  const RefinedModel truth = groundTruthOf(model);
  EXPECT_GT(pullOf(truth, kState).pull_over_load.std, 0.01);
  const PullForecast f = forecastPull(truth, kState, 0.5);
  const auto pull = [](double slip) {
    return equilibrium(sandModel().soil, kWheel, {.load_N = 80.0, .slip = slip}).drawbar_pull_N / 80.0;
  };
  EXPECT_NEAR(f.at_reference.value, pull(0.5), 1e-6);
  EXPECT_DOUBLE_EQ(f.at_reference.std, 0.0);
  EXPECT_NEAR(f.most.value, pull(f.most_slip), 1e-6);
  for (const double slip : kForecastSlips) EXPECT_LE(pull(slip), f.most.value + 1e-6);
  EXPECT_NEAR(std::tan(f.climbable_slope_rad.value), f.most.value, 1e-12);
  EXPECT_THROW((void)forecastPull(truth, kState, 0.0), std::invalid_argument);
  EXPECT_THROW((void)forecastPull(truth, kState, 1.5), std::invalid_argument);
}

TEST(PullFormula, EachNameSelectsItsFormula) {
  const Wheel wheel{.radius_m = 0.15, .width_m = 0.15};
  const WheelSample s{.load_N = 80.0, .torque_Nm = 5.0, .sinkage_m = 0.02, .slip = 0.3};
  const ReadingErrors errors = ReadingErrors::relative(0.05);
  const Estimate ours = pullOverLoad(wheel, s, errors);
  const auto by = [&](const char* name) { return pullOverLoadBy(name, wheel, s, errors); };
  EXPECT_EQ(by("single-force").value, ours.value);
  EXPECT_EQ(by("single-force").std, ours.std);
  EXPECT_EQ(by("small-angle").value, pullAtSmallAngle(wheel, s));
  EXPECT_EQ(by("triangular").value, pullOfTriangularStress(wheel, s));
  EXPECT_EQ(by("plane").value, kThesisPlane.at(wheel, s));
  // Property: the standard deviation includes the model error of the formula (drawbar_pull.hpp) in addition
  // to the errors of the readings.
  for (const char* name : {"small-angle", "triangular", "plane"}) EXPECT_GT(by(name).std, ours.std) << name;
  EXPECT_THROW(by("no-such"), std::invalid_argument);
  for (const std::string& name : pullFormulas()) EXPECT_NO_THROW(by(name.c_str()));
}

}  // namespace model_pull_test

}  // namespace talus::terramech
