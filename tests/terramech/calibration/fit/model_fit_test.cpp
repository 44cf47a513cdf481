#include <cmath>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace model_fit_test {

// Rows of the synthetic sand with pull readings that are too high by `offset_N`, with a sensor standard
// deviation of 1 N.
struct OffsetRows {
  RefinedModel model;
  Trial trial;
  Whitening white;

  explicit OffsetRows(double offset_N, int count = 16) {
    model.soil = madeSand();
    MadeRows rows(wheelColumns());
    std::mt19937_64 random(1);
    for (int k = 0; k < count; ++k) {
      std::vector<double> row = wheelRow(model.soil, 60.0, 0.1 + 0.04 * k, 0.0, random);
      row[4] += offset_N + (k % 2 ? 0.5 : -0.5);
      row[2] = row[3] = std::nan("");  // only the pull is measured
      rows.add(row);
    }
    trial = makeTrial(rows.telemetry(), model);
    white.factor.assign(static_cast<std::size_t>(count),
                        Eigen::Matrix4d(Eigen::Vector4d(60.0, 0, 0, 0).asDiagonal()));
    white.std = Eigen::MatrixXd::Constant(count, kChannels, 1.0 / 60.0);
    model.effects = {{.name = "drawbar_zero", .covariate = "load_N", .parameters = {0.0}}};
  }
};

TEST(ModelFit, OffsetEqualsMeanResidual) {
  const OffsetRows rows(3.0);
  SolvedContacts solved;
  FitPlan plan{.free = {{.effect = 0, .index = 0}}, .iterations = 30};
  const Fit fit = fitModel(rows.model, rows.trial, rows.white, plan, solved);
  // Closed form: mean 3 N, chi-squared 16 x 0.5^2, variance 1/16 of a mean of 16 values.
  EXPECT_NEAR(fit.model.effects[0].parameters[0], 3.0, 1e-3);
  EXPECT_NEAR(fit.chi2, 4.0, 1e-3);
  EXPECT_EQ(fit.prior_chi2, 0.0);
  EXPECT_NEAR(parameterCovariance(fit.model, rows.trial, rows.white, plan, solved)(0, 0), 1.0 / 16.0, 1e-4);
}

TEST(ModelFit, PriorWeighsAsAnAdditionalReading) {
  const OffsetRows rows(3.0);
  SolvedContacts solved;
  FitPlan plan{.free = {{.effect = 0, .index = 0}}, .effect_prior = {{0, {1.0, 0.25}}}, .iterations = 30};
  const Fit fit = fitModel(rows.model, rows.trial, rows.white, plan, solved);
  // Closed form: with equal weights 16 and 1/0.25^2 = 16 the result is the mean of 3 and 1; (2 - 1)^2/0.25^2
  // = 16.
  EXPECT_NEAR(fit.model.effects[0].parameters[0], 2.0, 1e-3);
  EXPECT_NEAR(fit.prior_chi2, 16.0, 0.05);
}

TEST(ModelFit, MisfitFactorReducesWeightOfRowsAgainstPrior) {
  const OffsetRows rows(3.0);
  SolvedContacts solved;
  FitPlan plan{.free = {{.effect = 0, .index = 0}},
               .effect_prior = {{0, {1.0, 0.25}}},
               .misfit = 4.0,
               .iterations = 30};
  // Closed form: the rows have the weight 16 / 4, the prior 16: (4 * 3 + 16 * 1) / 20.
  const RefinedModel fitted = fitModel(rows.model, rows.trial, rows.white, plan, solved).model;
  EXPECT_NEAR(fitted.effects[0].parameters[0], 1.4, 1e-3);
  EXPECT_NEAR(parameterCovariance(fitted, rows.trial, rows.white, plan, solved)(0, 0), 1.0 / 20.0, 1e-4);
  // Closed form: residuals 3 N +- 0.5 N with a noise of 1 N have the mean square 9.25; a tenth of them is
  // below the noise.
  const Eigen::VectorXd white =
      rows.white.apply(rows.trial.measured - predictRows(rows.model, rows.trial, solved));
  EXPECT_NEAR(misfitOf(white, rows.trial), 9.25, 1e-2);
  EXPECT_EQ(misfitOf(0.1 * white, rows.trial), 1.0);
}

TEST(ModelFit, EffectWithoutInformativeRowsFitsToZero) {
  OffsetRows rows(0.0);
  SolvedContacts solved;
  rows.model.effects = {{.name = "slope_weight_component", .covariate = "slope_rad", .parameters = {0.7}}};
  const FitPlan plan = fitPlan(rows.model, false);
  ASSERT_EQ(plan.free.size(), 1U);
  // Property: without rows on a slope the result is the mean of the prior, 0.
  EXPECT_NEAR(fitModel(rows.model, rows.trial, rows.white, plan, solved).model.effects[0].parameters[0], 0.0,
              1e-3);
}

TEST(ModelFit, ParameterIsClampedAtItsBound) {
  const OffsetRows rows(-800.0);
  SolvedContacts solved;
  FitPlan plan{.free = {{.effect = 0, .index = 0}}, .iterations = 60};
  EXPECT_EQ(fitModel(rows.model, rows.trial, rows.white, plan, solved).model.effects[0].parameters[0],
            -500.0);
}

TEST(ModelFit, JacobianMatchesReadingsAndIsZeroForUnmeasuredChannels) {
  const OffsetRows rows(0.0);
  SolvedContacts solved;
  const Eigen::MatrixXd j = jacobian(rows.model, rows.trial, {{.effect = 0, .index = 0}}, solved,
                                     [&](const Eigen::MatrixXd& m) { return rows.white.apply(m); });
  ASSERT_EQ(j.rows(), 16 * kChannels);
  for (int row = 0; row < 16; ++row) {
    EXPECT_NEAR(j(row * kChannels, 0), 1.0, 1e-6);  // Closed form: 1 N over 1 N
    for (int c = 1; c < kChannels; ++c) EXPECT_EQ(j(row * kChannels + c, 0), 0.0);
  }
}

TEST(ModelFit, PlanFreesEffectsAndSoilParametersWithPriorStd) {
  RefinedModel model;
  model.soil = madeSand();
  model.soil_prior_mean = {{"cohesion_Pa", 800.0}};
  model.soil_prior_std = {{"cohesion_Pa", 100.0}, {"sinkage_exponent", 0.0}};
  model.effects = {{.name = "multipass_stiffness", .covariate = "pass_index", .parameters = {0.4, 1.0, 1.0}}};
  const FitPlan plan = fitPlan(model, false);
  // The first pass is computed from the data and not fitted; cohesion is the only soil parameter with a
  // standard deviation.
  ASSERT_EQ(plan.free.size(), 3U);
  EXPECT_EQ(plan.free[0].effect, -1);
  EXPECT_STREQ(soilParameters()[static_cast<std::size_t>(plan.free[0].index)].name, "cohesion_Pa");
  EXPECT_EQ(plan.soil_prior.at(plan.free[0].index).std, 100.0);
  EXPECT_EQ(parametersOf(model, 0).size(), 2U);
  EXPECT_GT(fitPlan(model, true).free.size(), plan.free.size());
}

TEST(ModelFit, BoundsAreThoseOfTheEffectForm) {
  RefinedModel model;
  model.effects = {{.name = "elastic_rebound", .covariate = "sinkage_m", .parameters = {0.1}},
                   {.name = "empirical", .covariate = "slip", .parameters = {0.0}, .knots = {0.3}}};
  EXPECT_EQ(rangeOf(model, {.effect = 0, .index = 0}).high,
            findEffect("elastic_rebound")->parameters[0].high);
  EXPECT_LT(rangeOf(model, {.effect = 1, .index = 0}).low, -1.0);  // a curve may be negative
  EXPECT_EQ(rangeOf(model, {.effect = -1, .index = 0}).low, soilParameters()[0].low);
}

TEST(ModelFit, SoilWithoutStdIsFreeAndStatedStdIsKept) {
  RefinedModel model;
  model.soil.cohesion_Pa = 700.0;
  giveDefaultDeviations(model);
  // Closed form: the standard deviation is half of that of the vague soil; the mean is that of the soil.
  EXPECT_EQ(model.soil_prior_std.at("cohesion_Pa"), 1000.0);
  EXPECT_EQ(model.soil_prior_mean.at("cohesion_Pa"), 700.0);
  EXPECT_EQ(fitPlan(model, false).free.size(), 7U);
  RefinedModel stated;
  stated.soil_prior_std = {{"cohesion_Pa", 20.0}};
  giveDefaultDeviations(stated);
  EXPECT_EQ(stated.soil_prior_std.size(), 1U);
}

}  // namespace model_fit_test
namespace candidate_columns_test {

/// Rows of the synthetic sand whose torque readings are multiplied by `share`.
Trial rowsWithTorque(double share) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(6);
  for (int k = 0; k < 80; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 50.0 + (k * 7) % 60, 0.05 + 0.05 * ((k * 11) % 16), 0.02, random);
    row[2] *= share;
    rows.add(row);
  }
  RefinedModel model;
  model.soil = madeSand();
  return makeTrial(rows.telemetry(), model);
}

double gainOfEfficiency(double share) {
  RefinedModel model;
  model.soil = madeSand();
  TraceSearch search(model, rowsWithTorque(share), {});
  const EffectForm& form = *findEffect("torque_efficiency");
  const Effect effect{.name = form.name,
                      .covariate = form.covariate,
                      .channel = form.channel,
                      .parameters = {form.parameters.front().typical}};
  return search.gainsOf({{{effect}, form.family, 1}}).front();
}

// Property: the range of the factor eta, 0.3 to 2, allows torque readings that are too low and too high.
TEST(CandidateColumns, AFactorGainsInEitherSense) {
  EXPECT_GT(gainOfEfficiency(1.15), 20.0);
  EXPECT_GT(gainOfEfficiency(0.87), 20.0);
}

}  // namespace candidate_columns_test

}  // namespace talus::terramech
