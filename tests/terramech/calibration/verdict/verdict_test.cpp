#include <cmath>

#include <gtest/gtest.h>

#include <talus/terramech/calibration.hpp>

namespace talus::terramech {
namespace verdict_test {

/// A hundred rows of drawbar pull only, in runs of ten, with the given errors of base and refined model.
TraceResult resultOf(double base, double refined, double floor, std::size_t effects) {
  TraceResult result;
  for (int row = 0; row < 100; ++row) {
    WheelState s{.load_N = 50.0, .slip = 0.01 * row, .pass_index = 1.0 + row / 10 % 3};
    result.trial.states.push_back(s);
    result.trial.load_N.push_back(50.0);
    result.trial.run.push_back(row / 10);
  }
  result.trial.measured = Eigen::MatrixXd::Constant(100, kChannels, std::nan(""));
  result.trial.measured.col(0).setZero();
  result.base_rmse[0] = result.held_out.base_rmse[0] = base;
  result.refined_rmse[0] = result.held_out.refined_rmse[0] = refined;
  result.noise_floor[0] = floor;
  result.effects.resize(effects);
  result.threshold = 6.0;
  Candidate curve{{{.name = "empirical", .covariate = "slip"}}, "empirical", 2};
  result.last_promises.push_back({curve, 2.5, 0.4});
  return result;
}

TEST(Verdict, DistinguishesExplainedUnexplainedAndNothingMissing) {
  // Closed form: a variance of 100 values may exceed its floor by 3 sqrt(2/100) = 42 %, an rms by 19 %.
  EXPECT_EQ(answerOf(resultOf(0.0165, 0.0165, 0.0141, 0)).verdict, Verdict::NothingMissing);
  EXPECT_EQ(answerOf(resultOf(0.0170, 0.0170, 0.0141, 0)).verdict, Verdict::Unexplained);
  // Closed form: held-out rows are explained below 1.3 floors, whatever share of the residual that is.
  EXPECT_EQ(answerOf(resultOf(0.0345, 0.0182, 0.0141, 1)).verdict, Verdict::Explained);
  EXPECT_EQ(answerOf(resultOf(0.0345, 0.0184, 0.0141, 1)).verdict, Verdict::Unexplained);
  TraceResult result = resultOf(0.0150, 0.0150, 0.0141, 0);
  result.held_out.refined_rmse[0] = 0.03;
  EXPECT_EQ(answerOf(result).verdict, Verdict::NothingMissing);
  result.last_promises[0].gain = 6.5;  // more than noise would gain
  EXPECT_EQ(answerOf(result).verdict, Verdict::Unexplained);
}

TEST(Verdict, ParameterAtItsBoundExplainsNothing) {
  TraceResult result = resultOf(0.0345, 0.0150, 0.0141, 1);
  result.effects[0].chosen.candidate.parts = {
      {.name = "rear_fill", .covariate = "slip", .parameters = {1.0}}};
  const Answer a = answerOf(result);
  EXPECT_EQ(a.verdict, Verdict::Unexplained);
  EXPECT_EQ(a.at_bound, std::vector<std::string>{"rear_fill a"});
  EXPECT_EQ(a.base, 0.0345);
}

TEST(Verdict, ComparesResidualsWithDeclaredSensorNoise) {
  // Property: errors equal to a fitted noise of 0.0141 exceed the floor of a load cell with a tenth of this
  // noise stated.
  TraceResult result = resultOf(0.0141, 0.0141, 0.0141, 0);
  EXPECT_EQ(answerOf(result).verdict, Verdict::NothingMissing);
  result.strained = {{"drawbar_pull_N", 0.07, 0.7}};
  result.declared_floor[0] = 0.00141;
  const Answer a = answerOf(result);
  EXPECT_EQ(a.verdict, Verdict::Unexplained);
  EXPECT_EQ(a.floor, 0.00141);
  ASSERT_EQ(a.strained.size(), 1U);
  EXPECT_EQ(a.strained[0].column, "drawbar_pull_N");
}

TEST(Verdict, StrengthScatterIsReportedIfItDominatesTheResidual) {
  // Closed form: a scatter of strength of 0.1 changes drawbar pull over load by 0.03, most of the excess
  // 0.0345^2 - 0.0141^2 = 0.0315^2 above the floor.
  TraceResult result = resultOf(0.0345, 0.0345, 0.0141, 0);
  result.shared.run(kChannels, kChannels) = 0.1 * 0.1;
  result.shared.by_soil.assign(100, SoilFactor::Zero());
  for (SoilFactor& f : result.shared.by_soil) f(0, 0) = 0.3;
  EXPECT_NEAR(answerOf(result).strength_scatter, 0.1, 1e-12);
  EXPECT_EQ(answerOf(result).measure, "rows that record what else changed from run to run");
  // Units of five rows are stretches of time; units of ten rows are runs.
  for (int row = 0; row < 100; ++row) result.shared.unit.push_back(row / 5);
  EXPECT_EQ(answerOf(result).measure,
            "rows that record what else changed from stretch of time to stretch of time");
  result.shared.unit = result.trial.run;
  EXPECT_EQ(answerOf(result).unit, "run");
  for (SoilFactor& f : result.shared.by_soil) f(0, 0) = 0.2;
  EXPECT_EQ(answerOf(result).strength_scatter, 0.0);
}

TEST(Verdict, UnexplainedResidualNamesChannelColumnAndNextMeasurement) {
  TraceResult result = resultOf(0.0345, 0.0345, 0.0141, 0);
  Answer a = answerOf(result);
  EXPECT_EQ(a.channel, Channel::DrawbarPull);
  EXPECT_EQ(a.rest, 0.0345);
  EXPECT_EQ(a.column, "slip");
  EXPECT_EQ(a.measure, "rows over a wider range of slip, the other columns the same");
}

TEST(Verdict, SoilFarFromItsPriorIsReported) {
  TraceResult result = resultOf(0.01, 0.01, 0.01, 0);
  RefinedModel& model = result.refined;
  result.given = model.soil = {.cohesion_Pa = 1900.0, .cohesive_modulus = 0.0, .frictional_modulus = 1e6};
  model.soil_prior_mean = {{"cohesion_Pa", 1000.0}, {"log_stiffness", 0.0}};
  model.soil_prior_std = {{"cohesion_Pa", 100.0}, {"log_stiffness", 0.1}};
  ASSERT_EQ(movedSoil(result).size(), 1U);
  EXPECT_NEAR(movedSoil(result)[0].away(), 9.0, 1e-12);  // Closed form: (1900 - 1000) / 100
  model.soil.frictional_modulus *= std::exp(-0.5);
  ASSERT_EQ(movedSoil(result).size(), 2U);
  EXPECT_NEAR(movedSoil(result)[1].away(), -5.0, 1e-9);
}

TEST(Verdict, ParametersAtABoundAreReported) {
  Effect effect{.name = "rear_fill", .covariate = "slip", .parameters = {1.0}};
  EXPECT_EQ(atBounds(effect), std::vector<std::string>{"a"});
  effect.parameters = {0.99};
  EXPECT_TRUE(atBounds(effect).empty());
}

TEST(Verdict, PredictionNoiseIncludesSharedRunError) {
  // Closed form: hypot(0.3 N, 0.008 * 50 N) = 0.5 N.
  TraceResult result = resultOf(0.01, 0.01, 0.01, 0);
  result.refined.noise.absolute[0] = 0.3;
  result.shared.run(0, 0) = 0.008 * 0.008;
  EXPECT_NEAR(forPrediction(result).noise.absolute[0], 0.5, 1e-12);
}

TEST(Verdict, PredictionNoiseIncludesUnexplainedResidual) {
  TraceResult result = resultOf(0.05, 0.05, 0.03, 0);
  result.refined.noise.absolute[0] = 0.03 * 50.0;
  result.held_out.refined_rmse[0] = 0.05;
  EXPECT_EQ(answerOf(result).verdict, Verdict::Unexplained);
  // Closed form: hypot(0.03, 0.04) = 0.05 (floor and excess), times the load of 50 N.
  EXPECT_NEAR(forPrediction(result).noise.absolute[0], 2.5, 1e-12);
  result.held_out.refined_rmse[0] = 0.035;  // variance higher by 36 %, within three standard errors
  EXPECT_NEAR(forPrediction(result).noise.absolute[0], 1.5, 1e-12);
}

}  // namespace verdict_test
}  // namespace talus::terramech
