#include <cmath>

#include <talus/terramech/trace/trace_search.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace {

RefinedModel sand() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

// Rows of the made sand with 2 % errors, the torque 0.8 Nm more.
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

TEST(TraceSearch, ScreeningPutsWhatTheRowsHideFirst) {
  TraceSearch search(sand(), offsetTrial(), {});
  const auto screened = search.screen();
  ASSERT_FALSE(screened.empty());
  EXPECT_EQ(screened.front().candidate.family, "torque_sensor");
  for (std::size_t k = 1; k < screened.size(); ++k) EXPECT_LE(screened[k].score, screened[k - 1].score);
}

TEST(TraceSearch, WhatIsAcceptedIsFittedAndWhatIsDroppedIsGone) {
  TraceSearch search(sand(), offsetTrial(), {});
  const double before = search.chi2();
  search.accept(torqueOffset());
  // Property: the number that made the rows, within three standard deviations of a mean of 120 errors of 0.05 Nm
  // and the slip's share.
  ASSERT_EQ(search.parts(0).size(), 1U);
  EXPECT_NEAR(search.parts(0)[0].parameters[0], 0.8, 0.05);
  EXPECT_LT(search.chi2(), before);
  search.drop(0);
  EXPECT_TRUE(search.model().effects.empty());
  EXPECT_NEAR(search.chi2(), before, 1e-6 * before);
}

TEST(TraceSearch, LeavingOutKeepsTheNoiseAsItIs) {
  TraceSearch search(sand(), offsetTrial(), {});
  search.accept(torqueOffset());
  const double with = search.chi2();
  const SensorNoise noise = search.model().noise;
  search.leaveOut(0);
  EXPECT_GT(search.chi2(), 3.0 * with);  // 0.8 Nm against errors of 0.05 Nm
  EXPECT_EQ(search.model().noise.absolute, noise.absolute);
}

TEST(TraceSearch, AFreeParameterIsOneMoreSolve) {
  TraceSearch search(sand(), offsetTrial(), {});
  EXPECT_EQ(search.work(), 120.0 * 3.0);  // Closed form: rows x (free parameters + 3)
  search.accept(torqueOffset());
  EXPECT_EQ(search.work(), 120.0 * 4.0);
}

TEST(TraceSearch, ATrustedPriorHoldsTheFirstParameter) {
  TraceSearch search(sand(), offsetTrial(), {});
  search.trust({.value = 0.3, .std = 1e-4});
  search.accept(torqueOffset());
  EXPECT_NEAR(search.parts(0)[0].parameters[0], 0.3, 0.01);
}

}  // namespace
}  // namespace talus::terramech
