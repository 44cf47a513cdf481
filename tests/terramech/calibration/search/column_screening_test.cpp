#include <algorithm>
#include <numeric>
#include <set>

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/search/column_screening.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>

#include "calibration/traced_world.hpp"
#include "made_rows.hpp"

namespace talus::terramech {
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
