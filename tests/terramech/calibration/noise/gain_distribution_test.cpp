#include <gtest/gtest.h>

#include "calibration/synthetic_table.hpp"

namespace talus::terramech {
namespace gain_distribution_test {

TEST(GainDistribution, FalseAlarmRateIsFivePercentWithRunErrors) {
  // Property: of 120 tables with errors by run, about 6 exceed the threshold of 5 %; 13 or more have
  // probability 0.006.
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    SyntheticTable table(12, 8, 1.5, seed);
    std::vector<std::vector<double>> columns;
    for (int k = 0; k < 8; ++k) columns.push_back(k % 2 ? table.byRow() : table.byRun());
    const GainDistribution d = table.contest(columns, seed);
    alarms += *std::max_element(d.gain.begin(), d.gain.end()) > d.threshold(0.05);
  }
  EXPECT_LE(alarms, 12);
}

TEST(GainDistribution, EffectConstantWithinRunsIsFoundDespiteRunErrors) {
  // Property: the covariance of the runs' error is estimated again together with the effect, so that the
  // effect is found.
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SyntheticTable table(16, 10, 0.3, seed);
    const auto cause = table.byRun(), other = table.byRun(), noise = table.byRow();
    table.hide(cause, 1.0);
    const GainDistribution d = table.contest({other, cause, noise}, seed);
    found += d.gain[1] > d.threshold(0.05) && d.gain[1] > d.gain[0] && d.gain[1] > d.gain[2];
  }
  EXPECT_GE(found, 19);
}

TEST(GainDistribution, RunErrorsRaiseNoAlarmForCovariatesThatVaryByRun) {
  // Property: with an error of runs of five times the noise of rows, one run in twelve with a large error is
  // not found as a cause.
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SyntheticTable table(12, 20, 5.0, seed);
    const GainDistribution d = table.contest({table.byRun(), table.byRun(), table.byRun()}, seed);
    alarms += *std::max_element(d.gain.begin(), d.gain.end()) > d.threshold(0.05);
  }
  EXPECT_LE(alarms, 6);  // 2 expected; 7 or more have probability 0.004
}

TEST(GainDistribution, GainIncludesReturnOfTheSoilToItsPrior) {
  // Closed form: a known parameter fits a constant of 3 at eight standard deviations from its prior. A
  // contender of the same shape allows the parameter to return to its prior, a gain of 8^2 / 2 = 32.
  SyntheticTable table(10, 10, 0.0, 7);
  table.null.unit.clear();
  const std::vector<double> constant(100, 1.0);
  table.null.known.prior = {Eigen::VectorXd::Constant(1, -3.0), Eigen::VectorXd::Constant(1, 64.0 / 9.0)};
  const GainDistribution d = table.contest({constant});
  EXPECT_NEAR(d.gain[0], 32.0, 4.0);
}

TEST(GainDistribution, NullTablesDrawTheirSoilFromThePrior) {
  // Property: the departure of the fitted soil from its prior affects the gain of the table, but not the
  // gains of tables drawn from the null model.
  SyntheticTable table(10, 10, 0.0, 7);
  table.null.unit.clear();
  table.null.soil = 1;
  const std::vector<double> constant(100, 1.0);
  const auto threshold = [&](double prior) {
    table.null.known.prior = {Eigen::VectorXd::Constant(1, prior), Eigen::VectorXd::Constant(1, 64.0 / 9.0)};
    return table.contest({constant, table.byRow()}).threshold(0.05);
  };
  const double here = threshold(0.0);
  EXPECT_NEAR(threshold(-30.0), here, 0.5 + 0.2 * here);
  EXPECT_LT(here, 10.0);  // soils drawn about the fitted soil would give 32 and more
}

TEST(GainDistribution, NonNegativeContenderHasZeroGainForNegativeStep) {
  SyntheticTable table(10, 10, 0.0, 9);
  const auto cause = table.byRow();
  table.hide(cause, -1.0);
  const auto contest = [&](bool positive) {
    return gainDistribution(table.null,
                            {1,
                             [&](std::size_t) {
                               Contender c = SyntheticTable::added(cause);
                               c.positive = positive;
                               return c;
                             }},
                            0, 1, [](double) { return true; })
        .gain[0];
  };
  EXPECT_GT(contest(false), 20.0);
  EXPECT_EQ(contest(true), 0.0);
}

TEST(GainDistribution, PValueCountsTheObservedTable) {
  GainDistribution d;
  d.greatest = {0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(d.pValue(9.0), 0.2);  // Closed form: (0 + 1) / (4 + 1)
  EXPECT_EQ(d.pValue(2.0), 0.6);
  EXPECT_EQ(d.pValue(-1.0), 1.0);
  EXPECT_EQ(d.threshold(0.2), 3.0);
}

TEST(GainDistribution, StopsWhenTheWatchReturnsFalse) {
  SyntheticTable table(10, 10, 0.0, 9);
  int asked = 0;
  const auto column = table.byRow();
  const GainDistribution d =
      gainDistribution(table.null, {50, [&](std::size_t) { return SyntheticTable::added(column); }}, 99, 1,
                       [&](double) { return ++asked < 4; });
  EXPECT_EQ(asked, 4);
  EXPECT_TRUE(d.greatest.empty());
}

}  // namespace gain_distribution_test
}  // namespace talus::terramech
