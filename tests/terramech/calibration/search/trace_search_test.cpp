#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>

#include "calibration/traced_world.hpp"
#include "made_rows.hpp"

namespace talus::terramech {

namespace trace_search_test {

RefinedModel sand() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

// Rows of the synthetic sand with 2 % errors, and with a torque offset of 0.8 Nm.
Trial offsetTrial() {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(6);
  for (int k = 0; k < 120; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 40.0 + (k * 7) % 80, 0.05 + 0.05 * ((k * 11) % 16), 0.02, random);
    row[2] += 0.8;
    rows.add(row);
  }
  return makeTrial(rows.telemetry(), sand());
}

Candidate torqueOffset() {
  return {{{.name = "torque_offset", .covariate = "load_N", .channel = Channel::Torque, .parameters = {0.2}}},
          "torque_sensor",
          1};
}

TEST(TraceSearch, ScreeningRanksTheHiddenEffectFirst) {
  TraceSearch search(sand(), offsetTrial(), {});
  const auto screening = search.screen(19);
  ASSERT_FALSE(screening.promises.empty());
  EXPECT_EQ(screening.promises.front().candidate.family, "torque_sensor");
  EXPECT_GT(screening.promises.front().gain, screening.threshold);
  EXPECT_EQ(screening.promises.front().p_value, 0.05);  // Closed form: 1 / (19 + 1)
  for (std::size_t k = 1; k < screening.promises.size(); ++k)
    EXPECT_LE(screening.promises[k].gain, screening.promises[k - 1].gain);
}

TEST(TraceSearch, ScreenedGainEqualsFittedGainForALinearEffect) {
  // Property: an offset is linear, so that the linearised gain equals the fitted gain. Tolerance: the offset
  // changes the relative noise of slip and load.
  TraceSearch search(sand(), offsetTrial(), {});
  const Promise promise = search.screen(0).promises.front();
  EXPECT_NEAR(search.fitted(promise.candidate).gain, promise.gain, 0.02 * promise.gain);
}

TEST(TraceSearch, AcceptedEffectIsFittedAndLeftOutEffectIsRemoved) {
  TraceSearch search(sand(), offsetTrial(), {});
  const double before = search.chi2();
  search.accept(torqueOffset());
  // Property: the offset of the rows is found. Tolerance: three standard deviations of a mean of 120 errors
  // of 0.05 Nm, and the contribution of slip errors.
  ASSERT_EQ(search.parts(0).size(), 1U);
  EXPECT_NEAR(search.parts(0)[0].parameters[0], 0.8, 0.05);
  EXPECT_LT(search.chi2(), before);
  EXPECT_GT(search.gainOf(0), 100.0);
  search.leaveOut(0);
  search.settleAll();
  EXPECT_TRUE(search.model().effects.empty());
  EXPECT_NEAR(search.chi2(), before, 1e-6 * before);
}

TEST(TraceSearch, LeavingAnEffectOutKeepsTheNoise) {
  TraceSearch search(sand(), offsetTrial(), {});
  search.accept(torqueOffset());
  const double with = search.chi2();
  const SensorNoise noise = search.model().noise;
  search.leaveOut(0);
  EXPECT_GT(search.chi2(), 3.0 * with);  // the offset is 0.8 Nm, the errors are 0.05 Nm
  EXPECT_EQ(search.model().noise.absolute, noise.absolute);
}

TEST(TraceSearch, EffectAtItsBoundGainsNothing) {
  // Property: the rows contain no rebound, so that the fit of a rebound ends at the bound 0 and predicts as
  // without it.
  TraceSearch search(sand(), offsetTrial(), {});
  search.accept(torqueOffset());
  const Candidate rebound{
      {{.name = "elastic_rebound", .covariate = "sinkage_m", .parameters = {0.0}}}, "rebound", 1};
  EXPECT_NEAR(search.fitted(rebound).gain, 0.0, 1e-6);
  search.accept(rebound);
  EXPECT_NEAR(search.gainOf(1), 0.0, 1e-6);
}

TEST(TraceSearch, FormsFoundTogetherAreAcceptedOneByOne) {
  TraceSearch search(sand(), offsetTrial(), {});
  Candidate both = torqueOffset();
  both.parts.push_back({.name = "elastic_rebound", .covariate = "sinkage_m", .parameters = {0.1}});
  search.accept(both);
  ASSERT_EQ(search.parts(0).size(), 1U);
  EXPECT_EQ(search.parts(0)[0].name, "torque_offset");
  EXPECT_GT(search.gainOf(0), 100.0);
  EXPECT_EQ(search.parts(1)[0].name, "elastic_rebound");
}

TEST(TraceSearch, GainIncludesThePriorOfTheCandidate) {
  // Closed form: a curve has the prior 1/20 relative to a known form; its evidence excludes the prior.
  TraceSearch search(sand(), offsetTrial(), {});
  Effect curve{.name = "empirical", .covariate = "slip", .channel = Channel::Torque};
  curve.knots = {0.05, 0.8};
  curve.parameters = {0.0, 0.0};
  const Candidate line{{curve}, "empirical", 2};
  const Explanation fitted = search.fitted(line);
  EXPECT_NEAR(fitted.evidence() - fitted.gain, 3.0, 1e-12);
  EXPECT_NEAR(search.gainsOf({line}).front(), fitted.evidence(), 0.02 * fitted.gain);
}

}  // namespace trace_search_test
namespace rival_causes_test {

std::vector<std::string> columns(const TracedEffect& effect) {
  std::vector<std::string> all{effect.chosen.candidate.covariate()};
  for (const Explanation& e : effect.equal) all.push_back(e.candidate.covariate());
  std::sort(all.begin(), all.end());
  return all;
}

/// A world in which dust reduces the pull, with a second column correlated with dust.
blind::World tied() {
  const blind::World world =
      blind::makeWorld({.seed = 8, .effects = 1, .library = false, .unresolvable = "tied"});
  EXPECT_EQ(world.hidden[0].kind, "form:pull_dust_saturating");
  return world;
}

TEST(RivalCauses, CollinearColumnsAreReportedAsEqualCauses) {
  // Property: two columns, one a multiple of the other, are reported as equal causes.
  const TraceResult result = traced(tied());
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_EQ(columns(result.effects[0]), (std::vector<std::string>{"dust_index", "tied_0"}));
  ASSERT_FALSE(result.rivals.empty());
  EXPECT_EQ(result.rivals[0].in_place_of, result.effects[0].chosen.candidate.parts[0].name);
  EXPECT_EQ(result.rivals[0].model.effects.size(), result.refined.effects.size());
  EXPECT_FALSE(result.rivals[0].model.covariance.empty());
}

TEST(RivalCauses, IdentifiableCauseHasNoEqual) {
  // Property: without the correlated column the same world has one cause.
  blind::World world = tied();
  world.columns.pop_back();
  for (auto& row : world.rows) row.pop_back();
  const TraceResult result = traced(world);
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_EQ(columns(result.effects[0]), std::vector<std::string>{"dust_index"});
}

TEST(RivalCauses, ConstantOffsetHasNoDriftAsEqualCause) {
  // Property: with a constant zero error of the sinkage, a drift or a nearly constant curve is the same
  // offset and not a rival.
  const blind::World world =
      blind::makeWorld({.seed = 1303, .effects = 1, .library = true, .campaign = true});
  ASSERT_EQ(world.hidden[0].kind, "sinkage_datum");
  const TraceResult result = traced(world);
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_TRUE(result.effects[0].equal.empty());
}

}  // namespace rival_causes_test

namespace column_screening_test {

RefinedModel base() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

/// Rows in runs of ten, with random columns; the drawbar pull depends on the last but one.
Trial wide(int rows, int columns, double size) {
  MadeRows made(wheelColumns());
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < rows; ++k)
    made.add(wheelRow(madeSand(), 50.0 + 10.0 * (k % 3), 0.1 + 0.05 * (k % 7), 0.02, random), "a");
  Trial trial = makeTrial(made.telemetry("wheel"), base());
  for (int row = 0; row < rows; ++row) {
    trial.run[static_cast<std::size_t>(row)] = row / 10;
    WheelState& s = trial.states[static_cast<std::size_t>(row)];
    for (int c = 0; c < columns; ++c) s.extra.emplace_back("own" + std::to_string(c), normal(random));
    trial.measured(row, 0) += size * s.covariate("own" + std::to_string(columns - 2));
  }
  for (int c = 0; c < columns; ++c) trial.covariates.push_back("own" + std::to_string(c));
  return trial;
}

bool isIn(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

TEST(ColumnScreening, SampleIsStratifiedByRun) {
  // Closed form: one row of each stretch of five rows is drawn, for any period of the design.
  const Trial trial = wide(200, 2, 0.0);
  const auto keep = rowSample(trial, 40, 1);
  EXPECT_EQ(std::count(keep.begin(), keep.end(), 1), 40);
  std::set<double> slips;
  for (int row = 0; row < 200; ++row)
    if (keep[static_cast<std::size_t>(row)])
      slips.insert(std::round(20.0 * trial.slip[static_cast<std::size_t>(row)]));
  EXPECT_GE(slips.size(), 7U);
  for (int first = 0; first < 200; first += 5)
    EXPECT_EQ(std::accumulate(keep.begin() + first, keep.begin() + first + 5, 0), 1) << first;
  EXPECT_EQ(rowSample(trial, 40, 1), keep);
  EXPECT_EQ(rowSample(trial, 200, 1), std::vector<char>(200, 1));
}

TEST(ColumnScreening, RowsOfOneMomentAreSampledTogether) {
  Trial trial = wide(120, 2, 0.0);
  for (int row = 0; row < 120; ++row) trial.moment.push_back(row / 4);
  const auto keep = rowSample(trial, 40, 1);
  for (int row = 0; row < 120; row += 4)
    for (int other = 1; other < 4; ++other)
      EXPECT_EQ(keep[static_cast<std::size_t>(row)], keep[static_cast<std::size_t>(row + other)]);
  EXPECT_EQ(std::count(keep.begin(), keep.end(), 1), 40);
}

TEST(ColumnScreening, RelevantColumnIsKeptAmongForty) {
  TraceOptions options;
  options.most_columns = 6;
  const Trial trial = wide(120, 40, 0.02);
  const Trial screened = screenColumns(base(), trial, options, [](double) { return true; });
  EXPECT_EQ(screened.dropped.size(), 34U);
  EXPECT_TRUE(isIn(screened.covariates, "own38"));
  EXPECT_FALSE(isIn(screened.chance, "own38"));
  // Property: most of the kept columns have a gain that noise reaches by chance.
  EXPECT_GE(screened.chance.size(), 4U);
  EXPECT_TRUE(std::isnan(screened.states[0].covariate(screened.dropped[0])));
  // Closed form: ln(40 / 6).
  EXPECT_NEAR(furtherQuestions(screened), std::log(40.0 / 6.0), 1e-12);
  EXPECT_TRUE(screenColumns(base(), wide(60, 4, 0.0), options, [](double) { return true; }).dropped.empty());
}

TEST(ColumnScreening, ManyChanceColumnsYieldNoEffect) {
  TraceOptions options;
  options.most_columns = 6;
  EXPECT_TRUE(traceResiduals(base(), wide(120, 60, 0.0), options).effects.empty());
}

TEST(ColumnScreening, RowsOutsideTheSampleValidateTheEffect) {
  TraceOptions options;
  options.most_rows = 150;
  const TraceResult result = traceResiduals(base(), wide(400, 3, 0.02), options);
  EXPECT_EQ(result.trial.rows(), 150);
  EXPECT_EQ(result.unsearched.rows, 250);
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_EQ(result.effects[0].chosen.candidate.covariate(), "own1");
  // Property: an effect of 0.02, larger than the noise, causes most of the error on rows that were not used
  // for the fit.
  EXPECT_LT(result.unsearched.refined_rmse[0], 0.7 * result.unsearched.base_rmse[0]);
}

TEST(ColumnScreening, AcceptedEffectsReduceHeldOutErrorAndRejectedColumnsAreUnused) {
  // Property: the accepted effect reduces the error on runs held out of the search to that of the sensors;
  // without an effect in the data no effect is found.
  Trial trial = wide(240, 4, 0.02);
  for (std::size_t row = 0; row < 240; ++row)
    trial.states[row].group.emplace_back("site", row / 10 % 4 == 3 ? "east" : "west");
  const LeftOut east = leftOut(trial, "site=east", "made.csv").front();
  const LeftOutErrors errors = traceWithout(base(), trial, east, {}, {});
  ASSERT_EQ(errors.effects.size(), 1U);
  EXPECT_EQ(errors.effects[0], "empirical (own2)");
  EXPECT_LT(errors.refined[0], 0.7 * errors.base[0]);
  EXPECT_LT(errors.refined[0], 1.15 * errors.floor[0]);
  const Trial none = wide(240, 4, 0.0);
  EXPECT_TRUE(traceResiduals(base(), none).effects.empty());
}

}  // namespace column_screening_test

}  // namespace talus::terramech
