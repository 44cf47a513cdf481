#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

namespace talus::terramech {

/// Contender: a candidate for addition to a model, linearised about the fitted model.
struct Contender {
  LinearModel added;       ///< derivatives of the candidate's parameters, with their priors
  bool positive = false;   ///< true: the first parameter step must be >= 0
  double log_prior = 0.0;  ///< logarithm of the prior probability, a part of the gain
};

/// Number of contenders for which the run error (error shared by the rows of a run) is re-estimated in a
/// drawn table. The selected contenders are those of greatest gain under the null model's run error. The
/// contender of greatest gain is practically always among these twelve, and the cost remains that of matrix
/// products.
inline constexpr int kProfiled = 12;

/// Gain of every contender (candidate effect of this round) on the measured table, and greatest gains on tables drawn from the null model (the
/// current model without contenders).
struct GainDistribution {
  std::vector<double> gain;      ///< gain of each contender, in their order
  std::vector<double> greatest;  ///< greatest gain on each drawn table, ascending
  /// Score of the measured table under the null model: held-out log-likelihood plus prior term.
  double null_score = 0.0;
  RunError run = RunError::Zero();  ///< covariance of a run's error under the null model
  /// Logarithm of the ratio of the number of tests on the measured table to that on a drawn table. A
  /// log-likelihood ratio of noise exceeds x with a probability of order e^-x (Wilks). With N times as many
  /// tests, the greatest gain exceeds x + ln N with about the same probability (Bonferroni).
  double further_questions = 0.0;

  /// Returns the gain that the greatest gain on a drawn table exceeds with probability `level`.
  double threshold(double level) const;
  /// Returns the share of tables whose greatest gain is at least `reached`. The measured table counts as one
  /// of the tables, so that the share is at least 1 / (draws + 1).
  double pValue(double reached) const;
};

/// Null model, the reference of the gains: the current model, linearised on whitened rows.
struct NullModel {
  std::vector<SharedFactor> factor;  ///< effect of the error components shared by a run on each row
  std::vector<int> unit;             ///< run number of each row, from 0; empty: rows share no error
  Folds folds;                       ///< groups of rows that are held out together
  Eigen::VectorXd residual;          ///< whitened residuals, rows*kChannels
  LinearModel known;                 ///< derivatives with respect to the free parameters, with their priors
  RunError run_start;                ///< initial covariance of a run's error
  Eigen::Index soil = 0;             ///< number of leading columns of `known` that belong to the soil
};

/// Contenders by index. Each contender is requested once.
struct Contenders {
  std::size_t count = 0;
  std::function<Contender(std::size_t)> at;
};

/// Computes the gains of contenders on the measured table and on drawn tables. The gain of a contender is the
/// increase of the held-out log-likelihood when the contender is added to the null model, plus the change of
/// the prior term of the other parameters. The covariance of a run's error is estimated under both models. A
/// drawn table consists of the null model with a soil drawn from its prior, errors of unit variance, and
/// errors of runs with the estimated covariance. The soil is drawn because the fitted soil may be unrealistic
/// if an effect is missing. `go_on` receives the completed share; after a return value of false the remaining
/// gains are 0.
GainDistribution gainDistribution(const NullModel& null, const Contenders& contenders, int draws,
                                  std::uint64_t seed, const std::function<bool(double)>& go_on);

/// Returns the maximum-likelihood covariance of a run's error under a model.
RunError runErrorOf(const NullModel& null);

/// Returns the score of a fitted model, comparable to GainDistribution::null_score, from its residuals and
/// derivatives. The covariance of a run's error is re-estimated, starting from fitted.run_start.
double fittedScore(const NullModel& fitted);

}  // namespace talus::terramech
