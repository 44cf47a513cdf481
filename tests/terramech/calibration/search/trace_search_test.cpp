#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/search/trace_search.hpp>

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

}  // namespace talus::terramech
