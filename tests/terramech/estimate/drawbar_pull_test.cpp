#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <refused.hpp>
#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/numerics/functions.hpp>

#include "linear_world.hpp"

namespace talus::terramech {
namespace drawbar_pull_test {

Telemetry small() {
  Telemetry t;
  t.source = "drive.csv";
  t.numbers.push_back({"slip", {0.1, 0.2}});
  t.words.push_back({"run", {"a", "b"}});
  t.lines = {2, 3};
  return t;
}

TEST(Telemetry, FindsColumnsByName) {
  const Telemetry t = small();
  EXPECT_EQ(t.size(), 2U);
  EXPECT_EQ(t.at("slip")[1], 0.2);
  EXPECT_EQ((*t.findWords("run"))[0], "a");
  EXPECT_EQ(t.find("run"), nullptr);
  EXPECT_EQ(t.findWords("slip"), nullptr);
}

TEST(Telemetry, MissingColumnIsNamedInTheError) {
  EXPECT_THAT([] { small().at("load_N"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("drive.csv: no column load_N")));
}

TEST(Telemetry, ListsKnownColumns) {
  EXPECT_THAT(knownTelemetryColumns(), testing::Contains("sinkage_m"));
  EXPECT_THAT(knownTelemetryColumns(), testing::Not(testing::Contains("run")));
}

TEST(ReadingErrors, PartsAddInQuadrature) {
  // Closed form: hypot(0.03 x 100, 4) = 5; the sign of a reading does not matter.
  const ReadingError error{.relative = 0.03, .absolute = 4.0};
  EXPECT_DOUBLE_EQ(error.std(100.0), 5.0);
  EXPECT_DOUBLE_EQ(error.std(-100.0), 5.0);
  EXPECT_DOUBLE_EQ(error.std(0.0), 4.0);
}

TEST(ReadingErrors, RelativeErrorAppliesToAllFourReadings) {
  const ReadingErrors errors = ReadingErrors::relative(0.1);
  for (const ReadingError* e : {&errors.load, &errors.torque, &errors.sinkage, &errors.slip})
    EXPECT_DOUBLE_EQ(e->std(2.0), 0.2);
  EXPECT_DOUBLE_EQ(ReadingErrors{}.slip.std(0.4), 0.02);  // Printed in: the thesis, 5 % error of each reading
}

const WheelSample kSample{.load_N = 80, .torque_Nm = 3.2, .sinkage_m = 0.02, .slip = 0.5};

TEST(DrawbarPull, SingleForceEqualsItsComponents) {
  // Closed form: Eqs. 3.2, 3.3 (corrected: X sin theta): W = X sin + Y cos, T = r X, DP = X cos - Y sin.
  const double theta = 0.3;
  const double x = kSample.torque_Nm / kThesisWheel.radius_m;
  const double y = (kSample.load_N - x * std::sin(theta)) / std::cos(theta);
  const double pull = x * std::cos(theta) - y * std::sin(theta);
  EXPECT_NEAR(pullOfSingleForce(kThesisWheel, kSample, theta), pull / kSample.load_N, 1e-14);
}

TEST(DrawbarPull, TriangularStressAsPrintedEqualsTheStableForm) {
  // Printed in: thesis Eq. 3.12, evaluated as printed.
  const double t1 = entryAngle_rad(kThesisWheel, kSample.sinkage_m);
  const double p = 2.0 * std::cos(t1 / 2.0) - std::cos(t1) - 1.0;
  const double q = 2.0 * std::sin(t1 / 2.0) - std::sin(t1);
  const double pull = -q / p * kSample.load_N +
                      (p * p + q * q) / p * 4.0 / (t1 * t1) * kSample.torque_Nm / kThesisWheel.radius_m;
  EXPECT_NEAR(pullOfTriangularStress(kThesisWheel, kSample), pull / kSample.load_N, 1e-12);
}

TEST(DrawbarPull, TriangularStressIsExactForTriangularStresses) {
  // Property: the pull equals the integral over triangular stresses (midpoint rule, 1e-6).
  const LinearWorld world{.cohesion_Pa = 800.0, .offset = false};
  const WheelSample s = sampleOf(kThesisWheel, world, {.sinkage_m = 0.02, .slip = 0.4});
  const double theta_1 = entryAngle_rad(kThesisWheel, s.sinkage_m);
  const double tau_m = (world.cohesion_Pa + world.sigma_m_Pa * world.tan_friction) *
                       mobilisation(kThesisWheel, s, world.shear_modulus_m).peak;
  double pull = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {
    const double t = theta_1 * (k + 0.5) / kSteps;
    const double triangle = 1.0 - std::abs(2.0 * t / theta_1 - 1.0);
    pull += 0.01 * theta_1 / kSteps * triangle * (tau_m * std::cos(t) - world.sigma_m_Pa * std::sin(t));
  }
  EXPECT_NEAR(pullOfTriangularStress(kThesisWheel, s), pull / s.load_N, 1e-6);
}

TEST(DrawbarPull, FormulasAgreeAtVanishingSinkage) {
  // Property: Eq. 3.6 equals Eq. 3.12 to first order in theta_1.
  WheelSample s = kSample;
  s.sinkage_m = 1e-8;
  EXPECT_NEAR(pullOfTriangularStress(kThesisWheel, s), pullAtSmallAngle(kThesisWheel, s), 1e-7);
  s.sinkage_m = 0.0;
  EXPECT_DOUBLE_EQ(pullOfTriangularStress(kThesisWheel, s), 0.4);
}

// RMS error of our formula over soils of Table 2.1 on a wheel.
double rms(const Wheel& wheel) {
  ThesisRuns runs(77);
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < 40; ++k) {
    ThesisRun run = runs.next({.noise = 0.0, .samples = 10, .wheel = wheel});
    for (std::size_t i = 0; i < run.samples.size(); ++i, ++count) {
      squares += std::pow(pullOverLoad(wheel, run.samples[i]).value - run.pull_over_load[i], 2);
    }
  }
  return std::sqrt(squares / count);
}

TEST(DrawbarPull, RmsErrorIsWithinItsStatedAccuracy) {
  // Property: the rms error is the stated 0.002 for the wheel of the thesis, and below 0.006 for wheels of
  // other sizes.
  EXPECT_LT(rms(kThesisWheel), 0.003);
  EXPECT_LT(rms({.radius_m = 0.16, .width_m = 0.16}), 0.006);
  EXPECT_LT(rms({.radius_m = 0.065, .width_m = 0.08}), 0.006);
}

TEST(DrawbarPull, StdEqualsScatterOfNoisyReadings) {
  // Property: the stated standard deviation equals the scatter over 400 repetitions with 5 % noise.
  // Tolerance: 15 % (sampling and curvature).
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  double squares = 0.0;
  double stated = 0.0;
  const double truth = pullOverLoad(kThesisWheel, kSample).value;
  for (int k = 0; k < 400; ++k) {
    const auto noisy = [&](double v) { return v * (1.0 + 0.05 * normal(random)); };
    const WheelSample s{noisy(kSample.load_N), noisy(kSample.torque_Nm), noisy(kSample.sinkage_m),
                        noisy(kSample.slip)};
    const Estimate pull = pullOverLoad(kThesisWheel, s, ReadingErrors::relative(0.05));
    squares += std::pow(pull.value - truth, 2) / 400.0;
    stated += pull.std / 400.0;
  }
  EXPECT_NEAR(stated / std::sqrt(squares), 1.0, 0.15);
}

TEST(DrawbarPull, StdPropagatesEachReadingError) {
  // Property: a single error gives half the difference between the results at plus and minus the error,
  // combined in quadrature with the model error.
  const auto check = [](double WheelSample::*field, ReadingError ReadingErrors::*which) {
    ReadingErrors noise = ReadingErrors::relative(0.0);
    (noise.*which).relative = 0.02;
    WheelSample high = kSample, low = kSample;
    high.*field *= 1.02;
    low.*field *= 0.98;
    const double half =
        0.5 * (pullOverLoad(kThesisWheel, high).value - pullOverLoad(kThesisWheel, low).value);
    EXPECT_GT(std::abs(half), 5e-4);
    EXPECT_NEAR(pullOverLoad(kThesisWheel, kSample, noise).std, std::hypot(half, PullAngleModel{}.std), 1e-5);
  };
  check(&WheelSample::load_N, &ReadingErrors::load);
  check(&WheelSample::torque_Nm, &ReadingErrors::torque);
  check(&WheelSample::sinkage_m, &ReadingErrors::sinkage);
  check(&WheelSample::slip, &ReadingErrors::slip);
}

TEST(DrawbarPull, ClimbableSlopeIsArctanOfPullOverLoad) {
  // Closed form: slope = atan(DP/W), with the standard deviation multiplied by cos^2.
  const Estimate slope = climbableSlope_rad({.value = std::tan(0.3), .std = 0.01});
  EXPECT_NEAR(slope.value, 0.3, 1e-15);
  EXPECT_NEAR(slope.std, 0.01 * std::pow(std::cos(0.3), 2), 1e-15);
}

TEST(DrawbarPull, UnloadedWheelIsRejected) {
  WheelSample s = kSample;
  s.load_N = 0.0;
  EXPECT_REFUSED(pullOverLoad(kThesisWheel, s), std::invalid_argument, "load_N = 0, must be > 0");
}

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

}  // namespace drawbar_pull_test
}  // namespace talus::terramech
