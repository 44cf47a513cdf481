#include <algorithm>
#include <cmath>

#include <talus/terramech/calibration/held_out/end_levels.hpp>

#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace end_levels_test {

/// Rows predicted by `truth` at these slips and loads, three of each, and a result whose refined model is
/// `truth`.
TraceResult resultOf(const RefinedModel& base, const RefinedModel& truth, const std::vector<double>& slips) {
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
  TraceResult result = resultOf(sand(), truth, {0.1, 0.2, 0.3, 0.4, 0.5});
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
  TraceResult result = resultOf(sand(), truth, {-0.8, -0.6, -0.4, -0.2, 0.1, 0.2});
  boundEffects(result.refined, result.trial, endLevels(result, {}));
  // Levels of braked wheels are predicted from distant levels; of driven wheels only slip 0.2 is predicted,
  // from 0.1.
  EXPECT_LT(result.refined.effects[0].knots[0], -0.9);
  EXPECT_NEAR(result.refined.effects[1].knots[1], 0.3, 1e-12);
}

TEST(EndLevels, EffectSeenAtOneLevelIsConstantBeyondIt) {
  const auto with = [](double a) { return sand({digging("slip_sinkage_reece", a)}); };
  TraceResult result = resultOf(sand(), with(0.5), {-0.4, -0.2, 0.0, 0.2});
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
  TraceResult result = resultOf(sand(), sand(), {0.1, 0.2, 0.3});
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
  TraceResult result = resultOf(sand(), sand({digging("slip_sinkage_linear", 1.0)}), {0.1, 0.2, 0.3});
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
  const auto ends = endLevels(resultOf(sand(), sand(), {0.1, 0.3}), {});
  EXPECT_TRUE(std::none_of(ends.begin(), ends.end(), [](const EndLevel& e) { return e.column == "slip"; }));
}

}  // namespace end_levels_test
}  // namespace talus::terramech
