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
  const double sinkage = rmseOf(refittedBase(result, options, all), result.trial)[1];
  EXPECT_LT(sinkage, 0.01);
  result.base_shared = {};
  EXPECT_GT(rmseOf(refittedBase(result, options, all), result.trial)[1], 3.0 * sinkage);
}

}  // namespace held_out_test

namespace model_scope_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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
  return result;
}

WheelState stateAt(double slip) {
  return {.wheel = {.radius_m = 0.1, .width_m = 0.1}, .load_N = 60.0, .slip = slip};
}

TEST(ModelScope, ChannelWithALargerHeldOutErrorThanTheBaseIsThatOfTheBase) {
  TraceResult result = resultOf();
  result.scope = scopeOf(result);
  EXPECT_EQ(result.scope.share(stateAt(0.9), 0), 1.0);
  EXPECT_EQ(result.scope.share(stateAt(0.1), 2), 0.0);  // torque: 0.06, the base 0.05
  keepConfirmed(result.held_out, result.scope);
  EXPECT_EQ(result.held_out.refined_rmse[0], 0.02);
  EXPECT_EQ(result.held_out.refined_rmse[2], 0.05);
}

TEST(ModelScope, ModelWithoutEffectsHasFullShareAndNoBase) {
  TraceResult result = resultOf();
  result.refined.effects.clear();
  result.scope = scopeOf(result);
  EXPECT_FALSE(result.scope.base);
  EXPECT_EQ(result.scope.share(stateAt(0.9), 0), 1.0);
}

TEST(ModelScope, PredictionsMixTheModelsAndScopeRoundTrips) {
  TraceResult result = resultOf();
  result.scope = scopeOf(result);
  const test::TemporaryFile file{modelText(result.refined, result.scope)};
  const ModelFile back = loadModel(file.path());
  ASSERT_TRUE(back.scope.base);
  EXPECT_EQ(modelText(back.model, back.scope), modelText(result.refined, result.scope));
  SolvedContacts solved, other;
  const Eigen::MatrixXd base = predictRows(result.base, result.trial, solved),
                        refined = predictRows(result.refined, result.trial, other);
  const Eigen::MatrixXd mixed = predictInScope(result, result.trial);
  // Property: the sinkage is that of the refined model, the torque that of the base. Row 3 has slip 0.3.
  EXPECT_NEAR(mixed(3, 1), refined(3, 1), 1e-12);
  EXPECT_NEAR(mixed(3, 2), base(3, 2), 1e-12);
  EXPECT_GT(std::abs(base(3, 2) - refined(3, 2)), 0.001);
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

TEST(EndLevels, OutermostLevelIsPredictedFromTheOthers) {
  const TraceResult result =
      endResult(sand(), sand({digging("slip_sinkage_linear", 1.0)}), {0.1, 0.2, 0.3, 0.4, 0.5});
  const auto ends = endLevels(result, {});
  const auto high =
      std::ranges::find_if(ends, [](const EndLevel& e) { return e.column == "slip" && e.high; });
  ASSERT_NE(high, ends.end());
  EXPECT_EQ(high->rows, 6);
  EXPECT_NEAR(high->distance, 0.1, 1e-12);
  // Property: 1 + a i at i = 0.4, where the other rows end, leaves a fifth of the effect at i = 0.5.
  EXPECT_LT(high->refined_rmse[1], 0.25 * high->base_rmse[1]);  // the rows have no noise
}

TEST(EndLevels, EffectIsConstantOutsideTheRowsAlsoInItsFile) {
  const auto with = [](double a) { return sand({digging("slip_sinkage_reece", a)}); };
  const TraceResult result = endResult(sand(), with(0.5), {-0.4, -0.2, 0.0, 0.2});
  const RefinedModel model = withinRows(result.refined, result.trial);
  EXPECT_EQ(model.effects[0].knots, (std::vector<double>{-0.4, 0.2}));
  const WheelState beyond{
      .wheel = {.radius_m = 0.1, .width_m = 0.1, .grouser_height_m = 0.01}, .load_N = 80.0, .slip = 0.9};
  // Closed form: a h i/(1-i) is constant beyond i = 0.2, as with a = 0.5 (0.2/0.8) / (0.9/0.1) at i = 0.9.
  EXPECT_NEAR(predict(model, beyond).sinkage_m, predict(with(0.5 * 0.25 / 9.0), beyond).sinkage_m, 1e-9);
  const test::TemporaryFile file{modelText(model)};
  EXPECT_EQ(predict(loadModel(file.path()).model, beyond).sinkage_m, predict(model, beyond).sinkage_m);
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

TEST(EndLevels, TwoLevelsYieldNoEndLevels) {
  const auto ends = endLevels(endResult(sand(), sand(), {0.1, 0.3}), {});
  EXPECT_TRUE(std::none_of(ends.begin(), ends.end(), [](const EndLevel& e) { return e.column == "slip"; }));
}

}  // namespace model_scope_test

}  // namespace talus::terramech
