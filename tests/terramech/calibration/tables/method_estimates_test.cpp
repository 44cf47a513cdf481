#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/method_estimates.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/io/soil_library.hpp>

#include "calibration/wheel_table.hpp"
#include "linear_world.hpp"
#include "made_rows.hpp"
#include "requirement.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {

using testing::HasSubstr;
using testing::ThrowsMessage;

namespace line_estimate_test {

// Rows of a world with the stresses that the method assumes.
std::string linearRows(const LinearWorld& world, double second_radius_m = kMadeWheel.radius_m) {
  std::string text = kWheelHead + "\n";
  int k = 0;
  for (const WheelSample& s : linearSamples(kMadeWheel, world))
    text += wheelLine(s, {.radius_m = k++ % 2 ? second_radius_m : kMadeWheel.radius_m,
                          .width_m = kMadeWheel.width_m}) +
            "\n";
  return text;
}

SoilEstimate estimate(const std::string& content, EstimateOptions options) {
  const test::TemporaryFile file{content};
  options.table = file.path();
  return lineEstimate(options, {});
}

// Closed form: the rows have cohesion c = 3000 Pa and tan phi = 0.5 (phi: friction angle). Tolerance: the
// quadrature of the samples, 1e-7, amplified by the fit of the line.
TEST(LineEstimate, IsExactForDataOfItsOwnModel) {
  const SoilEstimate iagnemma =
      estimate(linearRows({.offset = false}), {.method = "iagnemma", .shear_modulus = "0.02"});
  EXPECT_NEAR(iagnemma.cohesion_Pa, 3000.0, 3.0);
  EXPECT_NEAR(iagnemma.tan_friction, 0.5, 1e-3);
  EXPECT_EQ(iagnemma.shear_modulus_m, 0.02);
  EXPECT_EQ(iagnemma.rows_used, 10U);
  EXPECT_EQ(iagnemma.points.size(), 10U);
}

TEST(LineEstimate, RecursiveEstimateEqualsBatchEstimate) {
  for (const char* method : {"linear-offset", "iagnemma", "sojourner"}) {
    const EstimateOptions all{.method = method, .shear_modulus = "0.02"};
    EstimateOptions recursive = all;
    recursive.recursive = true;
    const SoilEstimate a = estimate(linearRows({}), all), b = estimate(linearRows({}), recursive);
    ASSERT_EQ(b.running.size(), 10U) << method;
    EXPECT_NEAR(b.cohesion_Pa, a.cohesion_Pa, 1e-6 * std::abs(a.cohesion_Pa)) << method;
    EXPECT_NEAR(b.running.back().cohesion_Pa, a.cohesion_Pa, 1e-6 * std::abs(a.cohesion_Pa)) << method;
    EXPECT_TRUE(std::isnan(b.running.front().cohesion_Pa)) << method;  // one row does not determine a line
    EXPECT_EQ(b.running.front().line, 2U);
  }
}

TEST(LineEstimate, UnstatedShearModulusIsEstimated) {
  const SoilEstimate found = estimate(linearRows({}), {.method = "linear-offset"});
  EXPECT_NEAR(found.shear_modulus_m, 0.02, 0.002);
}

TEST(LineEstimate, ShearModulusComesFromTheFileColumnThenThePrior) {
  std::string content = linearRows({});
  std::string with_column;
  for (std::size_t at = 0, end; (end = content.find('\n', at)) != std::string::npos; at = end + 1)
    with_column += content.substr(at, end - at) + (at == 0 ? ",shear_modulus_m\n" : ",0.017\n");
  EXPECT_EQ(estimate(with_column, {.method = "linear-offset"}).shear_modulus_m, 0.017);
  const test::TemporaryFile prior{
      "{cohesion_Pa: {mean: 3000, std: 500}, friction_angle_rad: {mean: 0.46, std: 0.1}, sinkage_exponent: "
      "1.0, "
      "cohesive_modulus: 0, frictional_modulus: 1.0e6, shear_modulus_m: 0.023}\n",
      ".yaml"};
  EXPECT_EQ(estimate(content, {.method = "linear-offset", .prior = prior.path()}).shear_modulus_m, 0.023);
}

TEST(LineEstimate, WheelSizesRequireAStatedModulus) {
  EXPECT_THAT([] { estimate(linearRows({}, 0.16), {.method = "linear-offset"}); },
              ThrowsMessage<InputError>(HasSubstr("wheels of several sizes")));
  EXPECT_EQ(estimate(linearRows({}, 0.16), {.method = "linear-offset", .shear_modulus = "0.02"}).rows_used,
            10U);
}

}  // namespace line_estimate_test

namespace plate_estimate_test {

using testing::ElementsAre;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// Rows of tau = (c + sigma tan phi)(1 - e^{-j/K}) with c = 900 Pa, tan phi = 0.6, K = 0.015 m.
std::string shearRows() {
  std::string text = "normal_stress_Pa,shear_stress_Pa,shear_displacement_m\n";
  for (const double sigma : {1000.0, 3000.0, 8000.0})
    for (const double j : {0.004, 0.012, 0.03})
      text += number(sigma) + "," + number((900.0 + 0.6 * sigma) * -std::expm1(-j / 0.015)) + "," +
              number(j) + "\n";
  return text;
}

// Rows of p = (k_c/b + k_phi) z^n with k_phi = 4e5, n = 0.8, b = 50, 80 and 120 mm.
std::string plateRows(double cohesive_modulus) {
  std::string text = "plate_width_m,pressure_Pa,sinkage_m\n";
  for (const double b : {0.05, 0.08, 0.12})
    for (const double z : {0.005, 0.01, 0.02, 0.03})
      text +=
          number(b) + "," + number((cohesive_modulus / b + 4e5) * std::pow(z, 0.8)) + "," + number(z) + "\n";
  return text;
}

SoilEstimate estimate(const std::string& content, EstimateOptions options = {}) {
  const test::TemporaryFile file{content};
  options.table = file.path();
  options.method = "bevameter";
  return plateEstimate(options, {});
}

TEST(PlateEstimate, ExactShearTestsRecoverTheSoil) {
  const SoilEstimate found = estimate(shearRows());
  EXPECT_EQ(found.rows_used, 9U);
  EXPECT_NEAR(found.cohesion_Pa, 900.0, 0.01);
  EXPECT_NEAR(found.tan_friction, 0.6, 1e-6);
  EXPECT_NEAR(found.shear_modulus_m, 0.015, 1e-7);
  // Closed form: divided by the mobilised share, every point lies on the line.
  ASSERT_EQ(found.points.size(), 9U);
  for (const StressPair& p : found.points) EXPECT_NEAR(p.shear_Pa, 900.0 + 0.6 * p.normal_Pa, 0.05);
}

TEST(PlateEstimate, ExactPlateTestsRecoverTheModuli) {
  const SoilEstimate found = estimate(plateRows(2000.0));
  EXPECT_NEAR(found.sinkage_exponent, 0.8, 1e-9);
  ASSERT_TRUE(found.cohesive_modulus && found.frictional_modulus);
  EXPECT_NEAR(*found.cohesive_modulus, 2000.0, 1e-3);
  EXPECT_NEAR(*found.frictional_modulus, 4e5, 0.1);
  EXPECT_EQ(found.plates.size(), 3U);
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_TRUE(std::isnan(found.cohesion_Pa));  // pressure tests do not determine the cohesion
}

TEST(PlateEstimate, NegativeOrUnidentifiableModuliAreReported) {
  EXPECT_THAT(estimate(plateRows(-2000.0)).warnings, ElementsAre(HasSubstr("k_c < 0")));
  EXPECT_THAT(estimate(plateRows(0.0), {.plate_width_m = 0.1}).unseen,
              ElementsAre(HasSubstr("cohesive_modulus, frictional_modulus")));
}

TEST(PlateEstimate, PriorAppliesToShearTestsOnly) {
  const test::TemporaryFile prior{
      "{cohesion_Pa: {mean: 2000, std: 100}, friction_angle_rad: {mean: 0.5, std: 0.3}, sinkage_exponent: "
      "1.0, "
      "cohesive_modulus: 0, frictional_modulus: 1.0e6, shear_modulus_m: 0.02}\n",
      ".yaml"};
  EXPECT_NEAR(estimate(shearRows(), {.prior = prior.path()}).cohesion_Pa, 900.0,
              1.0);  // exact rows reduce the standard deviation
  EXPECT_THAT([&] { estimate(plateRows(0.0), {.prior = prior.path()}); },
              ThrowsMessage<InputError>(HasSubstr("the table has no shear test")));
}

}  // namespace plate_estimate_test

namespace model_estimate_test {

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
  EXPECT_THAT(
      [&] { estimate(diggingRows(), soil, {.recursive = true}); },
      ThrowsMessage<InputError>(HasSubstr("--recursive: cannot be combined with --method wong-reece")));
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

namespace table_estimate_test {

using testing::Contains;

SoilEstimate estimate(const std::string& path, EstimateOptions options = {}) {
  options.table = path;
  options.method = "wong-reece";
  return modelEstimate(options, {});
}

TEST(TableEstimate, SoilOfTheRowsLiesWithinThreeStandardDeviations) {
  const WheelTable table;
  const SoilEstimate found = estimate(table.path(), {.noise = 0.01});
  ASSERT_TRUE(found.model);
  EXPECT_EQ(found.cohesion_Pa, found.model->soil.cohesion_Pa);
  EXPECT_NEAR(found.cohesion_Pa, kMadeSoil.cohesion_Pa, 3.0 * std::sqrt(found.covariance(0, 0)));
  EXPECT_NEAR(found.tan_friction, std::tan(kMadeSoil.friction_angle_rad),
              3.0 * std::sqrt(found.covariance(1, 1)));
  EXPECT_TRUE(found.warnings.empty());
}

TEST(TableEstimate, StatedShearModulusIsKept) {
  const WheelTable table;
  EXPECT_EQ(estimate(table.path(), {.shear_modulus = "0.02"}).shear_modulus_m, 0.02);
}

// Rows of one load whose torque increases by step_Nm from row to row.
std::string torqueRows(double first_Nm, double step_Nm) {
  std::string text = kWheelHead + "\n";
  for (int k = 0; k < 12; ++k)
    text += wheelLine({100.0, first_Nm + step_Nm * k, 0.01, 0.1 + 0.05 * k}, kMadeWheel) + "\n";
  return text;
}

TEST(TableEstimate, RowBeyondTheAxleIsExcludedWithAWarning) {
  const std::string rows = torqueRows(5.0, 0.2);
  const test::TemporaryFile sound{rows}, deep{rows + wheelLine({100.0, 8.0, 0.17, 0.6}, kMadeWheel) + "\n"};
  const SoilEstimate of_deep = estimate(deep.path());
  EXPECT_EQ(of_deep.cohesion_Pa, estimate(sound.path()).cohesion_Pa);
  EXPECT_THAT(of_deep.warnings, Contains(HasSubstr("1 rows with sinkage at or above the axle")));
}

TEST(TableEstimate, MixedWheelWidthsAndImplausibleTorquesProduceWarnings) {
  std::string widths = kWheelHead + "\n";
  for (int k = 0; k < 12; ++k) {
    const Wheel wheel{.radius_m = 0.15, .width_m = k % 2 ? 0.1 : 0.15};
    const WheelForces f = equilibrium(kMadeSoil, wheel, madeOperation(k));
    widths +=
        wheelLine({madeOperation(k).load_N, f.torque_Nm, f.sinkage_m, madeOperation(k).slip}, wheel) + "\n";
  }
  const test::TemporaryFile two{widths};
  EXPECT_THAT(estimate(two.path()).warnings, Contains(HasSubstr("0.1 to 0.15 m wide")));
  // A torque of plausible size that falls by half with increasing slip, as on no soil.
  const test::TemporaryFile falling{torqueRows(15.0, -0.6)};
  EXPECT_THAT(estimate(falling.path(), {.noise = 0.02}).warnings,
              Contains(testing::AllOf(HasSubstr("no soil explains the readings"), HasSubstr("torque_Nm"))));
}

}  // namespace table_estimate_test

namespace model_soil_test {

RefinedModel digging() {
  RefinedModel model;
  model.soil = {.name = "sand",
                .cohesion_Pa = 900.0,
                .friction_angle_rad = 0.52,
                .sinkage_exponent = 1.05,
                .cohesive_modulus = 0.0,
                .frictional_modulus = 1.4e6,
                .shear_modulus_m = 0.015};
  model.wheel = Wheel{.radius_m = 0.1, .width_m = 0.1};
  model.effects = {
      {.name = "slip_sinkage_ding", .covariate = "slip", .channel = Channel::Sinkage, .parameters = {0.5}},
      {.name = "bulldozing", .covariate = "sinkage_m", .channel = Channel::DrawbarPull, .parameters = {2.0}}};
  return model;
}

/// Forty rows predicted by the model, each reading with a normal error of 2 %.
Trial drive(const RefinedModel& model) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> error(1.0, 0.02);
  MadeRows rows(wheelColumns());
  for (int k = 0; k < 40; ++k) {
    WheelState s{.wheel = *model.wheel, .load_N = 50.0 + 2.0 * k, .slip = 0.05 + 0.02 * ((k * 7) % 40)};
    const Reading r = predict(model, s);
    rows.add({s.load_N, s.slip, r.torque_Nm * error(random), r.sinkage_m * error(random),
              r.drawbar_pull_N + 0.02 * s.load_N * (error(random) - 1.0) / 0.02, 0.1, 0.1});
  }
  return makeTrial(rows.telemetry(), model);
}

/// The model as stored in a file after tracing on another ground.
RefinedModel elsewhere(RefinedModel model) {
  model.soil = {.name = "other",
                .cohesion_Pa = 200.0,
                .friction_angle_rad = 0.65,
                .sinkage_exponent = 0.8,
                .cohesive_modulus = 0.0,
                .frictional_modulus = 4e5,
                .shear_modulus_m = 0.025};
  return model;
}

TEST(ModelSoil, SoilIsRecoveredOnlyWithTheActiveEffects) {
  const RefinedModel truth = digging();
  const Trial trial = drive(truth);
  const ModelSoil with = soilUnder(elsewhere(truth), trial, {.noise = 0.02});
  // Property: the soil of the rows is found within three standard deviations.
  EXPECT_NEAR(with.model.soil.cohesion_Pa, 900.0, 3.0 * std::sqrt(with.strengthCovariance()(0, 0)));
  EXPECT_NEAR(std::tan(with.model.soil.friction_angle_rad), std::tan(0.52),
              3.0 * std::sqrt(with.strengthCovariance()(1, 1)));
  EXPECT_LT(std::sqrt(with.strengthCovariance()(1, 1)), 0.05);
  EXPECT_LT(with.misfit, 2.0);
  RefinedModel bare = elsewhere(truth);
  bare.effects.clear();
  const ModelSoil without = soilUnder(bare, trial, {.noise = 0.02});
  // Property: a soil without the effects does not explain the rows.
  EXPECT_GT(without.misfit, 3.0 * with.misfit);
}

TEST(ModelSoil, StatedShearModulusIsKept) {
  const ModelSoil found = soilUnder(digging(), drive(digging()), {.shear_modulus_m = 0.02, .noise = 0.02});
  EXPECT_EQ(found.model.soil.shear_modulus_m, 0.02);
}

TEST(ModelSoil, ParametersFixedByThePriorAreKept) {
  SoilPrior prior{.mean = digging().soil, .deviation = {.friction_angle_rad = 0.1}};
  prior.mean.cohesion_Pa = 500.0;
  const ModelSoil found = soilUnder(digging(), drive(digging()), {.prior = {prior}, .noise = 0.02});
  EXPECT_EQ(found.model.soil.cohesion_Pa, 500.0);
  EXPECT_EQ(found.strengthCovariance()(0, 0), 0.0);
  EXPECT_GT(found.strengthCovariance()(1, 1), 0.0);
}

/// The soil of a run of the thesis with ten samples and 5 % errors.
ModelSoil soilOf(const ThesisRun& run, const std::vector<SoilPrior>& priors) {
  MadeRows rows({"load_N", "torque_Nm", "sinkage_m", "slip"});
  for (const WheelSample& s : run.samples) rows.add({s.load_N, s.torque_Nm, s.sinkage_m, s.slip});
  RefinedModel model;
  model.wheel = kThesisWheel;
  return soilUnder(model, makeTrial(rows.telemetry(), model), {.prior = priors, .noise = 0.05});
}

// Property: over 40 soils of the four classes the truth lies within two standard deviations in 85 % of the cases or
// more (95 % expected, three standard errors), and the rms error is below the scatter of the classes, 2.1 kPa and
// 5.0 deg.
TEST(ModelSoil, MixtureOfClassesIsCalibratedAndBetterThanItsMean) {
  std::vector<SoilPrior> classes;
  for (const char* name : {"sand", "clay", "loam", "firm_soil"}) classes.push_back(soilPriors(name).front());
  ThesisRuns runs(5);
  int inside = 0;
  double cohesion = 0.0, friction = 0.0;
  constexpr int kSoils = 40;
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05});
    const ModelSoil found = soilOf(run, classes);
    const double c = found.model.soil.cohesion_Pa - run.soil.cohesion_Pa,
                 phi = found.model.soil.friction_angle_rad - run.soil.friction_angle_rad;
    inside += std::abs(c) < 2.0 * found.std("cohesion_Pa");
    inside += std::abs(phi) < 2.0 * found.std("friction_angle_rad");
    cohesion += c * c / kSoils;
    friction += phi * phi / kSoils;
    EXPECT_NEAR(std::accumulate(found.probability.begin(), found.probability.end(), 0.0), 1.0, 1e-12);
  }
  EXPECT_GE(inside, 0.85 * 2 * kSoils);
  EXPECT_LT(std::sqrt(cohesion), 2100.0);
  EXPECT_LT(std::sqrt(friction), 5.0 * kDegree);
}

}  // namespace model_soil_test

}  // namespace talus::terramech
