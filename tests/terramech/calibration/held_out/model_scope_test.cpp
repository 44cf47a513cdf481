#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/held_out/model_scope.hpp>

#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace model_scope_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

EndLevel greatestSlip(double distance, const ChannelErrors& base, const ChannelErrors& refined) {
  return {.column = "slip",
          .high = true,
          .distance = distance,
          .rows = 100,
          .base_rmse = base,
          .refined_rmse = refined};
}

/// Rows at slips from 0 to 0.3, with a refined model that has slip sinkage and a base that has not.
TraceResult resultOf() {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(5);
  for (int k = 0; k < 40; ++k)
    rows.add(wheelRow(madeSand(), 60.0 + 10.0 * (k % 3), 0.1 * (k % 4), 0.0, random));
  TraceResult result;
  result.base.soil = result.refined.soil = madeSand();
  result.refined.effects = {
      {.name = "slip_sinkage_linear", .covariate = "slip", .channel = Channel::Sinkage, .parameters = {1.0}}};
  result.trial = makeTrial(rows.telemetry(), result.base);
  result.noise_floor = {0.01, 0.01, 0.01, kNan};
  result.held_out.base_rmse = {0.05, 0.05, 0.05, kNan};
  result.held_out.refined_rmse = {0.02, 0.02, 0.06, kNan};
  // The corrections of drawbar pull are confirmed at the first distance only, those of sinkage at both.
  result.ends = {greatestSlip(0.1, {0.04, 0.04, 0.04, kNan}, {0.03, 0.03, 0.03, kNan}),
                 greatestSlip(0.25, {0.04, 0.04, 0.04, kNan}, {0.05, 0.03, 0.03, kNan})};
  return result;
}

WheelState stateAt(double slip) {
  return {.wheel = {.radius_m = 0.1, .width_m = 0.1}, .load_N = 60.0, .slip = slip};
}

TEST(ModelScope, CorrectionShareFallsToZeroBetweenConfirmedAndRefutedSlip) {
  const ModelScope scope = scopeOf(resultOf());
  // Closed form: pull is confirmed at distance 0.1 and contradicted at 0.25; share 1 up to 0.0875, 0 from
  // 0.175 on.
  const struct {
    double slip, pull, sinkage;
  } cases[] = {{0.3, 1.0, 1.0}, {0.3875, 1.0, 1.0}, {0.43125, 0.5, 1.0}, {0.475, 0.0, 1.0}, {0.9, 0.0, 1.0}};
  for (const auto& c : cases) {
    EXPECT_NEAR(scope.share(stateAt(c.slip), 0), c.pull, 1e-9) << c.slip;
    EXPECT_NEAR(scope.share(stateAt(c.slip), 1), c.sinkage, 1e-9) << c.slip;
    EXPECT_EQ(scope.share(stateAt(c.slip), 2), 0.0);  // contradicted inside the range
  }
}

TEST(ModelScope, HeldOutErrorPerChannelNeverExceedsThatOfTheBase) {
  TraceResult result = resultOf();
  result.scope = scopeOf(result);
  keepConfirmed(result.held_out, result.scope);
  keepConfirmed(result.ends, result.noise_floor);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LE(result.held_out.refined_rmse[c], result.held_out.base_rmse[c]);
    for (const EndLevel& end : result.ends) EXPECT_LE(end.refined_rmse[c], end.base_rmse[c]) << end.distance;
  }
}

TEST(ModelScope, HeldOutErrorWithinSensorNoiseRefutesNothing) {
  TraceResult result = resultOf();
  // Closed form: for one row, noise explains a squared error up to 1 + 1.645 sqrt(2) = 3.3 squared floors,
  // hence an error of 1.5 floors but not of 2.
  result.ends = {greatestSlip(0.1, {0.001, 0.001, 0.001, kNan}, {0.015, 0.02, 0.001, kNan})};
  result.ends[0].rows = 1;
  const ModelScope scope = scopeOf(result);
  EXPECT_EQ(scope.share(stateAt(0.9), 0), 1.0);
  EXPECT_EQ(scope.share(stateAt(0.9), 1), 0.0);
}

TEST(ModelScope, ModelWithoutEffectsHasFullShareAndNoBase) {
  TraceResult result = resultOf();
  result.refined.effects.clear();
  result.scope = scopeOf(result);
  EXPECT_FALSE(result.scope.base);
  EXPECT_EQ(result.scope.share(stateAt(0.9), 0), 1.0);
}

TEST(ModelScope, PredictionsOutsideScopeEqualTheBaseAndScopeRoundTrips) {
  TraceResult result = resultOf();
  result.scope = scopeOf(result);
  const test::TemporaryFile file{modelText(result.refined, result.scope)};
  const ModelFile back = loadModel(file.path());
  ASSERT_TRUE(back.scope.base);
  EXPECT_EQ(modelText(back.model, back.scope), modelText(result.refined, result.scope));
  Trial far = result.trial;
  for (WheelState& s : far.states) s.slip = 0.9;
  SolvedContacts solved, other;
  const Eigen::MatrixXd base = predictRows(result.base, far, solved),
                        refined = predictRows(result.refined, far, other);
  const Eigen::MatrixXd mixed = predictInScope(result, far);
  // Property: at slip 0.9 the pull is that of the base and the sinkage that of the refined model; the torque
  // is always that of the base.
  EXPECT_NEAR(mixed(0, 0), base(0, 0), 1e-12);
  EXPECT_NEAR(mixed(0, 1), refined(0, 1), 1e-12);
  EXPECT_GT(std::abs(base(0, 1) - refined(0, 1)), 0.01);
  for (WheelState& s : far.states) s.slip = 0.35;
  SolvedContacts near, beside;
  const Eigen::MatrixXd inside = predictInScope(result, far);
  EXPECT_NEAR(inside(0, 1), predictRows(result.refined, far, near)(0, 1), 1e-12);
  EXPECT_NEAR(inside(0, 2), predictRows(result.base, far, beside)(0, 2), 1e-12);
}

}  // namespace model_scope_test
}  // namespace talus::terramech
