#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <refused.hpp>

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

ShearStrength fitOf(double cohesion_Pa, double tan_friction, const Eigen::Vector2d& std, double correlation) {
  ShearStrength fit{.cohesion_Pa = cohesion_Pa, .tan_friction = tan_friction};
  const double both = correlation * std[0] * std[1];
  fit.covariance << std[0] * std[0], both, both, std[1] * std[1];
  fit.samples = 10;
  fit.unseen = {"cohesion_Pa: far"};
  return fit;
}

StrengthPrior priorOf(double cohesion_Pa, double tan_friction, const Eigen::Vector2d& std,
                      double probability = 1.0) {
  return {.mean = {cohesion_Pa, tan_friction},
          .covariance = std.cwiseAbs2().asDiagonal(),
          .probability = probability};
}

double normal(double away, double variance) {
  return std::exp(-0.5 * away * away / variance) / std::sqrt(variance);
}

TEST(StrengthPrior, MatchesIntegrationOverAGrid) {
  // Property: the result equals mean and covariance of prior times likelihood, summed over a fine grid of
  // (c, tan phi).
  const ShearStrength fit = fitOf(2200.0, 0.52, {900.0, 0.09}, -0.8);
  const std::vector<StrengthPrior> priors{priorOf(1000.0, 0.6, {400.0, 0.05}, 0.7),
                                          priorOf(4000.0, 0.4, {800.0, 0.04}, 0.3)};
  double sum = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  const Eigen::Matrix2d inverse = fit.covariance.inverse();
  for (double c = -3000.0; c < 9000.0; c += 40.0) {
    for (double t = 0.0; t < 1.1; t += 0.004) {
      const Eigen::Vector2d away(c - 2200.0, t - 0.52);
      double density = 0.0;
      for (const StrengthPrior& p : priors)
        density += p.probability * normal(c - p.mean[0], p.covariance(0, 0)) *
                   normal(t - p.mean[1], p.covariance(1, 1));
      const double weight = density * std::exp(-0.5 * away.dot(inverse * away));
      sum += weight;
      mean += weight * away;
      squares += weight * away * away.transpose();
    }
  }
  mean /= sum;
  const Eigen::Matrix2d covariance = squares / sum - mean * mean.transpose();
  const ShearStrength result = withPrior(fit, priors);
  EXPECT_NEAR(result.cohesion_Pa, 2200.0 + mean[0], 1.0);
  EXPECT_NEAR(result.tan_friction, 0.52 + mean[1], 1e-4);
  EXPECT_NEAR(result.covariance(0, 0) / covariance(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(result.covariance(1, 1) / covariance(1, 1), 1.0, 1e-3);
  EXPECT_NEAR(result.covariance(0, 1) / covariance(0, 1), 1.0, 1e-3);
  EXPECT_EQ(result.unseen, fit.unseen);
}

TEST(StrengthPrior, FixedValuesAreKeptAndVaguePriorHasNoEffect) {
  const ShearStrength fit = fitOf(2200.0, 0.52, {900.0, 0.09}, -0.8);
  const std::vector<StrengthPrior> known{priorOf(1000.0, 0.6, {0.0, 0.0})};
  EXPECT_DOUBLE_EQ(withPrior(fit, known).cohesion_Pa, 1000.0);
  EXPECT_NEAR(withPrior(fit, known).covariance.norm(), 0.0, 1e-9);
  const std::vector<StrengthPrior> vague{priorOf(0.0, 0.0, {1e8, 1e4})};
  EXPECT_NEAR(withPrior(fit, vague).cohesion_Pa, 2200.0, 0.1);
  EXPECT_NEAR(withPrior(fit, vague).tan_friction, 0.52, 1e-5);
}

TEST(StrengthPrior, ExactReadingsOverridePriorWithNonZeroStd) {
  const ShearStrength fit = fitOf(2200.0, 0.52, {0.0, 0.0}, 0.0);
  const std::vector<StrengthPrior> prior{priorOf(1000.0, 0.6, {400.0, 0.05})};
  EXPECT_NEAR(withPrior(fit, prior).cohesion_Pa, 2200.0, 0.1);
}

TEST(StrengthPrior, ConvertsAngleStdToTangentStd) {
  // Closed form: d tan(phi) = d phi / cos(phi)^2, at 45 deg twice as wide.
  SoilPrior soil{.mean = {.name = "x", .cohesion_Pa = 500.0, .friction_angle_rad = std::atan(1.0)},
                 .deviation = {.cohesion_Pa = 100.0, .friction_angle_rad = 0.03}};
  const StrengthPrior prior = strengthPrior(soil);
  EXPECT_NEAR(prior.mean[1], 1.0, 1e-12);
  EXPECT_NEAR(prior.covariance(1, 1), 0.06 * 0.06, 1e-12);
  EXPECT_NEAR(prior.covariance(0, 0), 1e4, 1e-9);
}

TEST(StrengthPrior, FitWithoutCovarianceAndEmptyPriorAreRejected) {
  ShearStrength two = fitOf(1.0, 0.5, {1.0, 1.0}, 0.0);
  two.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<StrengthPrior> prior{priorOf(1000.0, 0.6, {400.0, 0.05})};
  EXPECT_REFUSED(withPrior(two, prior), std::domain_error,
                 "at least three samples are required to estimate the scatter");
  EXPECT_REFUSED(withPrior(fitOf(1.0, 0.5, {1.0, 1.0}, 0.0), {}), std::invalid_argument, "no kind of soil");
}

}  // namespace model_pull_test

}  // namespace talus::terramech
