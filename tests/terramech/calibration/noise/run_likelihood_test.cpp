#include <cmath>
#include <map>
#include <random>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

#include "calibration/synthetic_table.hpp"
#include "made_rows.hpp"

namespace talus::terramech {

namespace run_likelihood_test {

constexpr int kRuns = 6, kRows = 4;

/// Rows of four channels with random shared factors; runs of four rows; folds of two runs.
struct Made {
  std::vector<SharedFactor> factor;
  std::vector<int> unit;
  Folds folds{"", {}, 3};
  Eigen::VectorXd table;
  LinearModel model;
  RunError run;

  explicit Made(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&](Eigen::Index rows, Eigen::Index columns) {
      return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
    };
    for (int row = 0; row < kRuns * kRows; ++row) {
      Eigen::Matrix4d f = noise(4, 4).triangularView<Eigen::Lower>();
      f.diagonal() = f.diagonal().cwiseAbs().array() + 0.5;
      SharedFactor& all = factor.emplace_back();
      all << f, noise(4, kShared - 4);
      unit.push_back(row / kRows);
      folds.of_row.push_back(row / kRows % 3);
    }
    const Eigen::Index values = static_cast<Eigen::Index>(factor.size()) * kChannels;
    table = noise(values, 1);
    model = {noise(values, 2), {noise(2, 1), Eigen::Vector2d(0.3, 2.0)}};
    const RunError root = noise(kShared, kShared);
    run = root * root.transpose();
  }

  /// Dense covariance of all whitened readings.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd v = Eigen::MatrixXd::Identity(table.size(), table.size());
    for (std::size_t i = 0; i < unit.size(); ++i)
      for (std::size_t j = 0; j < unit.size(); ++j)
        if (unit[i] == unit[j])
          v.block<4, 4>(4 * static_cast<Eigen::Index>(i), 4 * static_cast<Eigen::Index>(j)) +=
              factor[i] * run * factor[j].transpose();
    return v;
  }

  std::vector<Eigen::Index> values(int fold, bool held) const {
    std::vector<Eigen::Index> all;
    for (std::size_t row = 0; row < unit.size(); ++row)
      for (int c = 0; c < kChannels; ++c)
        if ((folds.of_row[row] == fold) == held) all.push_back(4 * static_cast<Eigen::Index>(row) + c);
    return all;
  }
};

/// Log density of the readings `unseen` given those of `seen`, from the dense mean and covariance of all
/// readings.
double logDensity(const Eigen::VectorXd& table, const Eigen::VectorXd& mean,
                  const Eigen::MatrixXd& covariance, const std::vector<Eigen::Index>& seen,
                  const std::vector<Eigen::Index>& unseen) {
  const Eigen::MatrixXd gain = covariance(unseen, seen) * covariance(seen, seen).inverse();
  const Eigen::MatrixXd own = covariance(unseen, unseen) - gain * covariance(seen, unseen);
  const Eigen::VectorXd left = table(unseen) - mean(unseen) - gain * (table(seen) - mean(seen));
  return -0.5 * (left.dot(own.inverse() * left) + std::log(own.determinant()));
}

TEST(RunLikelihood, EqualsTheDenseGaussian) {
  // Independent derivation: with the parameters integrated out, all readings are one Gaussian, and the
  // readings of each fold are conditioned on the others. Only fold 0 depends on the third parameter.
  Made made(1);
  made.model.columns.conservativeResize(Eigen::NoChange, 3);
  made.model.columns.col(2).setZero();
  for (const Eigen::Index value : made.values(0, true))
    made.model.columns(value, 2) = 3.0 + 0.1 * static_cast<double>(value);
  made.model.prior = {Eigen::Vector3d(0.5, -1.0, 0.2), Eigen::Vector3d(0.3, 2.0, 0.01)};
  RunLikelihood likelihood(made.factor, made.unit, made.folds);
  likelihood.setTables(made.table);
  const HeldOutFit fit = likelihood.heldOut(likelihood.sums(made.model), made.run, 0, 1);
  const Eigen::MatrixXd& x = made.model.columns;
  const Eigen::MatrixXd covariance =
      made.covariance() + x * made.model.prior.precision.cwiseInverse().asDiagonal() * x.transpose();
  double expected = 0.0;
  for (int fold = 0; fold < 3; ++fold)
    expected += logDensity(made.table, x * made.model.prior.mean, covariance, made.values(fold, false),
                           made.values(fold, true));
  EXPECT_NEAR(fit.log_likelihood[0], expected, 1e-6 * std::abs(expected));
}

TEST(RunLikelihood, NoPriorCountsTwice) {
  // Independent derivation: generalised least squares with the dense covariance. The prior of a parameter
  // that only one fold determines counts in the density of that fold; for other parameters the least
  // departure over all fits without one fold counts.
  Made made(5);
  const Eigen::MatrixXd v = made.covariance();
  const Eigen::MatrixXd precision = made.model.prior.precision.asDiagonal();
  Eigen::VectorXd least = Eigen::VectorXd::Constant(2, 1e300);
  for (int fold = -1; fold < 3; ++fold) {  // -1: all rows
    const auto rows = made.values(fold, false);
    const Eigen::MatrixXd x = made.model.columns(rows, Eigen::all), weight = v(rows, rows).inverse();
    const Eigen::VectorXd step =
        (x.transpose() * weight * x + precision)
            .ldlt()
            .solve(x.transpose() * weight * made.table(rows) + precision * made.model.prior.mean);
    least = least.cwiseMin(precision * (step - made.model.prior.mean).cwiseAbs2());
  }
  RunLikelihood likelihood(made.factor, made.unit, made.folds);
  likelihood.setTables(made.table);
  const auto left = [&] {
    return likelihood.heldOut(likelihood.sums(made.model), made.run, 0, 1).prior_chi2[0];
  };
  EXPECT_NEAR(left(), least.sum(), 1e-6 * least.sum());
  for (const Eigen::Index value : made.values(0, false)) made.model.columns.row(value).setZero();
  EXPECT_NEAR(left(), 0.0, 1e-6);
}

TEST(RunLikelihood, AKnotOfHeldOutRunsAloneCostsItsPriorNotItsHeight) {
  // Closed form: n = 24 readings of unit variance in one fold, all higher by h = 50 than the others, and a
  // parameter of that fold alone with the prior 0 +- s, s = 100. ln p = -(h^2 / s^2 + ln(1 + n s^2)) / 2 to
  // first order in 1 / (n s^2); without the parameter the loss is n h^2 / 2 = 30 000.
  const int rows = 24;
  std::vector<int> fold;
  Eigen::VectorXd table = Eigen::VectorXd::Zero(2 * rows * kChannels), column = table;
  std::vector<SharedFactor> factor(2 * rows, SharedFactor::Zero());
  for (int row = 0; row < 2 * rows; ++row) {
    fold.push_back(row / rows);
    if (fold.back() == 1) table[row * kChannels] = 50.0, column[row * kChannels] = 1.0;
  }
  RunLikelihood likelihood(factor, {}, {"", fold, 2});
  likelihood.setTables(table);
  const LinearModel knot{column, {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 1e-4)}};
  EXPECT_NEAR(likelihood.heldOut(likelihood.sums(knot), RunError::Zero(), 0, 1).score()[0],
              -0.5 * (0.25 + std::log(1.0 + rows * 1e4)), 1e-4);
}

TEST(RunLikelihood, SumsOfPartsAreThoseOfTheWhole) {
  const Made made(2);
  RunLikelihood likelihood(made.factor, made.unit, made.folds);
  likelihood.setTables(made.table);
  const auto part = [&](Eigen::Index k) {
    return LinearModel{made.model.columns.col(k),
                       {made.model.prior.mean.segment(k, 1), made.model.prior.precision.segment(k, 1)}};
  };
  const RunSums joined = likelihood.sums(likelihood.sums(part(0)), part(0), part(1));
  EXPECT_NEAR(likelihood.heldOut(joined, made.run, 0, 1).score()[0],
              likelihood.heldOut(likelihood.sums(made.model), made.run, 0, 1).score()[0], 1e-9);
}

TEST(RunLikelihood, FindsTheErrorThatRunsShareAndBetweenWhichChannels) {
  // Property: 400 runs of 5 rows have an error of 0.8 in the first channel, and half of that error in the
  // third. Tolerance: four times the 7 % standard error of a covariance from 400 draws.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<int> unit, fold;
  Eigen::VectorXd table(400 * 5 * kChannels);
  for (int run = 0; run < 400; ++run) {
    const double common = 0.8 * normal(random);
    for (int k = 0; k < 5; ++k) {
      unit.push_back(run);
      fold.push_back(run % 5);
      for (int c = 0; c < kChannels; ++c)
        table[(run * 5 + k) * kChannels + c] = normal(random) + (c == 0   ? common
                                                                 : c == 2 ? 0.5 * common
                                                                          : 0.0);
    }
  }
  RunLikelihood likelihood(std::vector<SharedFactor>(2000, SharedFactor::Identity()), unit, {"", fold, 5});
  likelihood.setTables(table);
  const LinearModel none{Eigen::MatrixXd::Zero(table.size(), 1),
                         {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)}};
  const RunError run = likelihood.profile(likelihood.sums(none), RunError::Identity(), 0, 60);
  EXPECT_NEAR(run(0, 0), 0.64, 0.2);
  EXPECT_NEAR(run(0, 2), 0.32, 0.12);
  EXPECT_NEAR(run(2, 2), 0.16, 0.08);
  EXPECT_LT(run(1, 1), 0.05);
  EXPECT_NEAR(run(0, 1), 0.0, 0.06);
}

TEST(RunLikelihood, RowsWithoutRunsShareNothing) {
  const Made made(4);
  RunLikelihood likelihood(made.factor, {}, made.folds);
  likelihood.setTables(made.table);
  EXPECT_NEAR(likelihood.logLikelihood(made.run, 0), -0.5 * made.table.squaredNorm(), 1e-9);
}

}  // namespace run_likelihood_test
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
namespace run_units_test {

struct Rows {
  Trial trial;
  Whitening white;
  Eigen::MatrixXd residual;

  Rows(int rows, int runs, std::uint64_t seed) : random(seed) {
    residual = Eigen::MatrixXd::Constant(rows, kChannels, std::nan(""));
    for (int row = 0; row < rows; ++row) {
      trial.states.push_back({.load_N = 50.0, .slip = 0.3, .time_s = 10.0 * row});
      trial.run.push_back(runs > 0 ? row * runs / rows : row);
      residual(row, 0) = normal(random);
    }
    white.std = Eigen::MatrixXd::Ones(rows, kChannels);
    white.factor.assign(static_cast<std::size_t>(rows),
                        Eigen::Matrix4d(Eigen::Vector4d(1, 0, 0, 0).asDiagonal()));
  }

  std::vector<int> units() const { return runUnits(trial, white, residual); }

  void last(double correlation) {
    for (Eigen::Index row = 1; row < residual.rows(); ++row)
      residual(row, 0) =
          correlation * residual(row - 1, 0) + std::sqrt(1.0 - correlation * correlation) * residual(row, 0);
  }

  std::mt19937_64 random;
  std::normal_distribution<double> normal;
};

int countOf(const std::vector<int>& unit) {
  return unit.empty() ? 0 : *std::max_element(unit.begin(), unit.end()) + 1;
}

TEST(RunUnits, EqualTheGivenRuns) {
  EXPECT_EQ(countOf(Rows(200, 10, 1).units()), 10);
}

TEST(RunUnits, RowsWithIndependentNoiseAndNoRunsFormNoUnits) {
  EXPECT_TRUE(Rows(200, 0, 2).units().empty());
}

TEST(RunUnits, AutocorrelatedNoiseIsSplitIntoTimeSegments) {
  Rows alone(300, 0, 5), in_runs(300, 6, 6);
  alone.last(0.8);
  in_runs.last(0.8);
  EXPECT_GT(countOf(alone.units()), 10);
  EXPECT_LT(countOf(alone.units()), 100);
  EXPECT_GT(countOf(in_runs.units()), 6);
}

TEST(RunUnits, AutocorrelationAlongSlipIsNotTreatedAsNoise) {
  Rows rows(300, 6, 6);
  rows.trial.covariates = {"slip"};
  rows.last(0.8);
  for (int row = 0; row < 300; ++row) rows.trial.states[static_cast<std::size_t>(row)].slip = row % 50 / 60.0;
  EXPECT_EQ(countOf(rows.units()), 6);
  for (WheelState& s : rows.trial.states) s.time_s = std::nan("");
  EXPECT_EQ(countOf(rows.units()), 6);
}

TEST(RunUnits, RowsOfOneMomentShareAUnit) {
  Rows rows(400, 0, 7);
  rows.last(0.95);
  for (int row = 0; row < 400; ++row) {
    rows.trial.moment.push_back(row / 4);
    rows.trial.states[static_cast<std::size_t>(row)].time_s = row / 4;
  }
  rows.trial.run = rows.trial.moment;
  const std::vector<int> unit = rows.units();
  ASSERT_EQ(unit.size(), 400U);
  for (std::size_t row = 1; row < 400; ++row)
    if (row % 4 != 0) {
      EXPECT_EQ(unit[row], unit[row - 1]);
    }
}

TEST(RunUnits, UnitMeansAreInverseVarianceWeightedAndZeroIfEmpty) {
  // Closed form: (1/1 * 2 + 1/4 * 7) / (1 + 1/4) = 3.
  Eigen::MatrixXd residual(3, 2), std(3, 2);
  residual << 2.0, std::nan(""), 7.0, 5.0, 9.0, std::nan("");
  std << 1.0, 1.0, 2.0, 1.0, 1.0, 1.0;
  const Eigen::MatrixXd mean = unitMeans(residual, std, {0, 0, 1});
  EXPECT_NEAR(mean(0, 0), 3.0, 1e-14);
  EXPECT_NEAR(mean(1, 0), 3.0, 1e-14);
  EXPECT_EQ(mean(2, 0), 9.0);
  EXPECT_EQ(mean(0, 1), 0.0);
  EXPECT_EQ(mean(1, 1), 5.0);
  EXPECT_EQ(mean(2, 1), 0.0);
}

}  // namespace run_units_test

namespace folds_test {

Trial trialOf(const MadeRows& rows, const std::string& column = "") {
  return makeTrial(rows.telemetry(column), RefinedModel{});
}

/// Expects that all rows with one value of the key are in one fold, and each row in a valid fold.
void expectWhole(const Folds& folds, const std::vector<double>& key) {
  std::map<double, std::set<int>> seen;
  ASSERT_EQ(folds.of_row.size(), key.size());
  for (std::size_t row = 0; row < key.size(); ++row) {
    seen[key[row]].insert(folds.of_row[row]);
    EXPECT_GE(folds.of_row[row], 0);
    EXPECT_LT(folds.of_row[row], folds.count);
  }
  for (const auto& [value, in] : seen) EXPECT_EQ(in.size(), 1U) << value;
  EXPECT_GT(seen.size(), 1U);
}

TEST(Folds, RowsOfARunStayTogether) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{1};
  std::vector<double> run;
  for (int k = 0; k < 60; ++k) {
    run.push_back(k % 7);
    rows.add({50.0, 0.1 + 0.01 * k, 1.0, 0.01, 5.0, 0.1, 0.1}, "run" + std::to_string(k % 7));
  }
  const Folds folds = foldsOf(trialOf(rows, "run"));
  EXPECT_NE(folds.scheme.find("runs"), std::string::npos);
  expectWhole(folds, run);
}

TEST(Folds, SlipLevelsStayTogether) {
  MadeRows rows(wheelColumns());
  std::vector<double> slip;
  for (int k = 0; k < 48; ++k) {
    slip.push_back(0.1 * (k % 6 + 1));
    rows.add({40.0 + k, slip.back(), 1.0, 0.01, 5.0, 0.1, 0.1});
  }
  const Folds folds = foldsOf(trialOf(rows));
  EXPECT_NE(folds.scheme.find("slip levels"), std::string::npos);
  expectWhole(folds, slip);
}

TEST(Folds, LevelsOfSignedColumnAreHeldOutOneByOne) {
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("slip_angle_rad");
  MadeRows rows(columns);
  std::vector<double> angle;
  for (int k = 0; k < 40; ++k) {
    angle.push_back(0.25 * (k % 4));
    rows.add({50.0, 0.3, 1.0, 0.01, 5.0, 0.1, 0.1, k % 8 < 4 ? angle.back() : -angle.back()});
  }
  const Folds folds = levelFolds(trialOf(rows), "slip_angle_rad");
  EXPECT_EQ(folds.count, 4);
  expectWhole(folds, angle);
  EXPECT_EQ(levelFolds(trialOf(rows), "load_N").count, 0);  // a single level
}

TEST(Folds, HeldOutAndTrainingRowsAreComplementary) {
  const Folds folds{"", {0, 1, 0, 2}, 3};
  EXPECT_EQ(rowsOf(folds, 0, true), (std::vector<char>{1, 0, 1, 0}));
  EXPECT_EQ(rowsOf(folds, 0, false), (std::vector<char>{0, 1, 0, 1}));
}

}  // namespace folds_test

}  // namespace talus::terramech
