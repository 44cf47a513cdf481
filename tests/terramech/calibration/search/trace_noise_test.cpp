#include <cmath>

#include <talus/terramech/calibration/search/trace_search.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace trace_noise_test {

// Rows of the made sand with errors of a share of each reading; the pull of run number k off by `run_offset`.
Trial noisyTrial(const RefinedModel& model, double noise, double run_offset = 0.0) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(4);
  std::normal_distribution<double> offset(0.0, run_offset + 1e-12);
  double off = 0.0;
  for (int k = 0; k < 160; ++k) {
    if (k % 16 == 0) off = offset(random);
    std::vector<double> row =
        wheelRow(model.soil, 50.0 + (k * 7) % 60, 0.05 + 0.05 * ((k * 11) % 16), noise, random);
    row[4] += off * row[0];
    rows.add(row, "run" + std::to_string(k / 16));
  }
  return makeTrial(rows.telemetry("run"), model);
}

RefinedModel sand() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

// Property: residuals over their own noise have unit variance. Tolerance: 480 values know theirs to 6.5 %.
TEST(TraceNoise, WhitenedResidualsHaveUnitVariance) {
  for (const double noise : {0.01, 0.05}) {
    const Trial trial = noisyTrial(sand(), noise);
    EXPECT_NEAR(TraceSearch(sand(), trial, {}).chi2() / 480.0, 1.0, 0.2) << noise;
  }
}

TEST(TraceNoise, TheSensorsErrorIsFound) {
  const TraceSearch search(sand(), noisyTrial(sand(), 0.05), {});
  const SensorNoise& noise = search.model().noise;
  // Closed form: 5 % of a torque of some T = 0.3 r W = 2.4 Nm, as absolute and relative parts together.
  EXPECT_NEAR(std::hypot(noise.absolute[2], 2.4 * noise.relative[2]), 0.12, 0.04);
}

TEST(TraceNoise, WhatRunsShareIsNoNoiseOfTheirRows) {
  TraceSearch search(sand(), noisyTrial(sand(), 0.02, 0.1), {});
  TraceResult together;
  search.finish(together);
  ASSERT_EQ(together.shared.unit.size(), 160U);
  // Property: ten offsets of 0.1 know their own variance to 45 %.
  EXPECT_NEAR(std::sqrt(together.shared.run(0, 0)), 0.1, 0.05);
  // Property: the offsets' 0.1 of the load is not taken for the sensor's 2 % of a pull of some 0.3 W.
  const SensorNoise& noise = search.model().noise;
  EXPECT_LT(std::hypot(noise.absolute[0] / 80.0, 0.3 * noise.relative[0]), 0.03);
  TraceResult alone;
  TraceSearch(sand(), noisyTrial(sand(), 0.02), {}).finish(alone);
  EXPECT_LT(std::sqrt(alone.shared.run(0, 0)), 0.01);
}

}  // namespace trace_noise_test
}  // namespace talus::terramech
