#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/held_out/held_out.hpp>

#include "calibration/traced_world.hpp"
#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {

namespace held_out_test {

TEST(HeldOut, HeldOutErrorIsReducedOnHiddenLibraryEffect) {
  const blind::World world = blind::makeWorld({.seed = 10, .effects = 1, .library = true});
  const TraceResult result = traced(world);
  const HeldOut& held = result.held_out;
  EXPECT_FALSE(held.scheme.empty());
  EXPECT_LT(held.refined_rmse[1], held.base_rmse[1]);
}

/// Runs of constant moisture, which reduces the pull in proportion to slip: not a form of the library. The
/// standard deviation of the soil is 10 %, and the sensor errors are stated.
TraceResult moistRuns(unsigned seed) {
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("moisture_pct");
  MadeRows rows(columns);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> moistures(1.0, 9.0);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 12; ++run) {
    const double moisture = moistures(random);
    for (int k = 0; k < 12; ++k) {
      const double load = 50.0 + 30.0 * (run % 3), slip = 0.02 + 0.055 * k;
      std::vector<double> row = wheelRow(madeSand(), load, slip, 0.0, random);
      row[2] += 0.15 * normal(random);
      row[3] += 0.001 * normal(random);
      row[4] += 0.57 * normal(random) - 0.048 * moisture * slip * load;
      row.push_back(moisture);
      rows.add(row, "run" + std::to_string(run));
    }
  }
  RefinedModel base;
  base.soil = madeSand();
  base.soil.friction_angle_rad *= 0.965;
  base.soil.frictional_modulus *= 1.19;
  base.soil.shear_modulus_m *= 0.84;
  for (const auto& [name, mean] : std::initializer_list<std::pair<const char*, double>>{
           {"cohesion_Pa", base.soil.cohesion_Pa},
           {"friction_angle_rad", base.soil.friction_angle_rad},
           {"sinkage_exponent", base.soil.sinkage_exponent},
           {"frictional_modulus", base.soil.frictional_modulus},
           {"shear_modulus_m", base.soil.shear_modulus_m}}) {
    base.soil_prior_mean[name] = mean;
    base.soil_prior_std[name] = 0.1 * mean;
  }
  base.stated = {.load_N = 1.6, .slip = 0.01, .torque_Nm = 0.15, .sinkage_m = 0.001, .drawbar_pull_N = 0.57};
  TraceOptions options;
  return traceResiduals(base, makeTrial(rows.telemetry("run"), base), options);
}

TEST(HeldOut, ReportedErrorIsThatOfPredictions) {
  for (const unsigned seed : {1U, 5U}) {
    const TraceResult result = moistRuns(seed);
    ASSERT_FALSE(result.effects.empty());
    const Trial rows = asMeasured(result.trial);
    const ChannelErrors predicted = rmseOf(predictInScope(result, rows), rows);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(result.refined_rmse[c], predicted[c]) << seed;
  }
}

TEST(SquaredErrors, AreRootMeanSquaresByChannelWithoutNaN) {
  // Closed form: residuals 3 and 4 have the mean square 12.5; a channel without values has NaN.
  Eigen::MatrixXd residual = Eigen::MatrixXd::Constant(2, kChannels, std::nan(""));
  residual(0, 0) = 3.0;
  residual(1, 0) = 4.0;
  residual(1, 2) = -2.0;
  SquaredErrors errors;
  errors.add(residual);
  EXPECT_DOUBLE_EQ(errors.rmse()[0], std::sqrt(12.5));
  EXPECT_TRUE(std::isnan(errors.rmse()[1]));
  EXPECT_DOUBLE_EQ(errors.rmse()[2], 2.0);
}

TEST(RefittedBase, KeepsRunOffsetsOutOfTheSoilFit) {
  // Property: pull offsets of runs do not change the soil if modelled as shared errors; as errors of single
  // rows they change the soil.
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(7);
  TraceResult result;
  for (int run = 0; run < 10; ++run)
    for (int k = 0; k < 8; ++k) {
      std::vector<double> row = wheelRow(madeSand(), 60.0 + 5.0 * k, 0.05 + 0.06 * run, 0.01, random);
      row[4] -= 0.025 * run * row[0];
      rows.add(row);
      result.base_shared.unit.push_back(run);
    }
  result.base.soil = madeSand();
  result.base.noise.absolute = {0.8, 0.0005, 0.1, 0.0};
  result.base_shared.run(0, 0) = 0.1 * 0.1;
  result.trial = makeTrial(rows.telemetry(), result.base);
  const std::vector<char> all(80, 1);
  TraceOptions options;
  options.fit_soil = true;
  const double sinkage = rmseAsMeasured(refittedBase(result, options, all), result.trial)[1];
  EXPECT_LT(sinkage, 0.01);
  result.base_shared = {};
  EXPECT_GT(rmseAsMeasured(refittedBase(result, options, all), result.trial)[1], 3.0 * sinkage);
}

}  // namespace held_out_test

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

/// Rows predicted by `truth` at these slips and loads, three of each, and a result whose refined model is
/// `truth`.
TraceResult endResult(const RefinedModel& base, const RefinedModel& truth, const std::vector<double>& slips) {
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("grouser_height_m");
  MadeRows rows(columns);
  for (const double slip : slips)
    for (const double load_N : {60.0, 80.0, 100.0})
      for (const double height_m : {0.0, 0.01}) {
        const WheelState s{.wheel = {.radius_m = 0.1, .width_m = 0.1, .grouser_height_m = height_m},
                           .load_N = load_N,
                           .slip = slip};
        const Reading r = predict(truth, s);
        rows.add({load_N, slip, r.torque_Nm, r.sinkage_m, r.drawbar_pull_N, 0.1, 0.1, height_m});
      }
  TraceResult result;
  result.base = base;
  result.refined = truth;
  result.base.noise.absolute = result.refined.noise.absolute = {0.5, 2e-4, 0.05, 1.0};
  result.trial = makeTrial(rows.telemetry(), base);
  result.noise_floor = {0.01, 0.002, 0.01, 0.01};
  return result;
}

RefinedModel sand(std::vector<Effect> effects = {}) {
  RefinedModel model;
  model.soil = madeSand();
  model.effects = std::move(effects);
  return model;
}

/// An effect of slip sinkage with the parameter a.
Effect digging(const char* name, double a) {
  return {.name = name, .covariate = "slip", .channel = Channel::Sinkage, .parameters = {a}};
}

const EndLevel& endOf(const std::vector<EndLevel>& ends, const std::string& column, bool high) {
  return *std::find_if(ends.begin(), ends.end(),
                       [&](const EndLevel& e) { return e.column == column && e.high == high; });
}

TEST(EndLevels, LawIsExtrapolatedByTheDistanceItPredictedHeldOutLevels) {
  const auto with = [](double a) { return sand({digging("slip_sinkage_linear", a)}); };
  const RefinedModel truth = with(1.0);
  TraceResult result = endResult(sand(), truth, {0.1, 0.2, 0.3, 0.4, 0.5});
  const auto ends = endLevels(result, {});
  const EndLevel& high = endOf(ends, "slip", true);
  EXPECT_TRUE(high.law);
  EXPECT_EQ(high.rows, 6);
  EXPECT_NEAR(high.edge, 0.4, 1e-12);
  EXPECT_NEAR(high.distance, 0.1, 1e-12);
  EXPECT_LT(high.refined_rmse[1], 0.1 * high.base_rmse[1]);  // the rows have no noise
  boundEffects(result.refined, result.trial, ends);
  // The end with slips 0.4 and 0.5 was predicted from 0.3; the formula therefore applies to 0.2 beyond 0.5,
  // up to 0.7.
  WheelState beyond{.wheel = {.radius_m = 0.1, .width_m = 0.1}, .load_N = 80.0, .slip = 0.69};
  EXPECT_EQ(predict(result.refined, beyond).sinkage_m, predict(truth, beyond).sinkage_m);
  beyond.slip = 0.9;
  // Closed form: 1 + a i is constant beyond i = 0.7, as with a = 0.7/0.9 at i = 0.9.
  EXPECT_NEAR(predict(result.refined, beyond).sinkage_m, predict(with(0.7 / 0.9), beyond).sinkage_m, 1e-9);
}

TEST(EndLevels, EachEffectOfAColumnHasItsOwnExtrapolationRange) {
  const RefinedModel truth = sand({digging("skid_sinkage", 0.3), digging("slip_sinkage_linear", 1.0)});
  TraceResult result = endResult(sand(), truth, {-0.8, -0.6, -0.4, -0.2, 0.1, 0.2});
  boundEffects(result.refined, result.trial, endLevels(result, {}));
  // Levels of braked wheels are predicted from distant levels; of driven wheels only slip 0.2 is predicted,
  // from 0.1.
  EXPECT_LT(result.refined.effects[0].knots[0], -0.9);
  EXPECT_NEAR(result.refined.effects[1].knots[1], 0.3, 1e-12);
}

TEST(EndLevels, EffectSeenAtOneLevelIsConstantBeyondIt) {
  const auto with = [](double a) { return sand({digging("slip_sinkage_reece", a)}); };
  TraceResult result = endResult(sand(), with(0.5), {-0.4, -0.2, 0.0, 0.2});
  const auto ends = endLevels(result, {});
  const EndLevel& high = endOf(ends, "slip", true);
  EXPECT_FALSE(high.law);
  // Property: no other level contains the effect, so that the effect at the end is not predicted.
  EXPECT_NEAR(high.refined_rmse[1], high.base_rmse[1], 0.05 * high.base_rmse[1]);
  boundEffects(result.refined, result.trial, ends);
  const WheelState beyond{
      .wheel = {.radius_m = 0.1, .width_m = 0.1, .grouser_height_m = 0.01}, .load_N = 80.0, .slip = 0.9};
  // Closed form: a h i/(1-i) is constant beyond i = 0.2, as with a = 0.5 (0.2/0.8) / (0.9/0.1) at i = 0.9.
  EXPECT_NEAR(predict(result.refined, beyond).sinkage_m, predict(with(0.5 * 0.25 / 9.0), beyond).sinkage_m,
              1e-9);
}

TEST(EndLevels, StdGrowsByHeldOutErrorAboveNoiseFloorPerDistance) {
  TraceResult result = endResult(sand(), sand(), {0.1, 0.2, 0.3});
  EndLevel end{.column = "slip", .high = true, .distance = 0.2, .rows = 4};
  end.base_rmse = end.refined_rmse = {0.05, 0.001, NAN, NAN};
  const auto ranges = trainedRanges(result.trial, {end}, {0.03, 0.002, NAN, NAN});
  const auto slip =
      std::find_if(ranges.begin(), ranges.end(), [](const auto& r) { return r.column == "slip"; });
  ASSERT_NE(slip, ranges.end());
  EXPECT_NEAR(slip->above[0], 0.04 / 0.2, 1e-12);  // Closed form: sqrt(0.05^2 - 0.03^2) over the distance
  EXPECT_EQ(slip->above[1], 0.0);
  EXPECT_EQ(slip->below[0], 0.0);
  // Closed form: each end has the weight of its rows, also a farther end without excess: 4 (0.05^2 - 0.03^2)
  // / (4 0.2^2 + 12 0.4^2).
  EndLevel half{.column = "slip", .high = true, .distance = 0.4, .rows = 12};
  half.base_rmse = half.refined_rmse = {0.03, 0.002, NAN, NAN};
  EXPECT_NEAR(trainedRanges(result.trial, {end, half},
                            {0.03, 0.002, NAN, NAN})[static_cast<std::size_t>(slip - ranges.begin())]
                  .above[0],
              std::sqrt(4.0 * 0.0016 / (4.0 * 0.04 + 12.0 * 0.16)), 1e-12);
  EXPECT_EQ(slip->low, 0.1);
  EXPECT_EQ(slip->high, 0.3);
}

TEST(EndLevels, BoundedModelRoundTripsThroughItsFile) {
  TraceResult result = endResult(sand(), sand({digging("slip_sinkage_linear", 1.0)}), {0.1, 0.2, 0.3});
  boundEffects(result.refined, result.trial, {{.column = "slip", .high = true, .law = true, .reach = {0.2}}});
  ASSERT_EQ(result.refined.effects[0].knots.size(), 2U);
  EXPECT_EQ(result.refined.effects[0].knots[0], 0.1);
  EXPECT_EQ(result.refined.effects[0].knots[1], 0.3 + 0.2);
  const test::TemporaryFile file{modelText(result.refined)};
  const WheelState beyond{.wheel = {.radius_m = 0.1, .width_m = 0.1}, .load_N = 80.0, .slip = 0.9};
  EXPECT_EQ(predict(loadModel(file.path()).model, beyond).sinkage_m,
            predict(result.refined, beyond).sinkage_m);
}

TEST(EndLevels, TwoLevelsYieldNoEndLevels) {
  const auto ends = endLevels(endResult(sand(), sand(), {0.1, 0.3}), {});
  EXPECT_TRUE(std::none_of(ends.begin(), ends.end(), [](const EndLevel& e) { return e.column == "slip"; }));
}

}  // namespace model_scope_test

}  // namespace talus::terramech
