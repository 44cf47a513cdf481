#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

namespace talus::terramech {

/// A candidate for addition to a model, linearised.
struct Contender {
  LinearModel added;
  bool positive = false;  ///< the first step must be >= 0
};

/// Number of contenders whose run error is profiled in a drawn table: the contenders of greatest gain under
/// the null model's run error. The contender of greatest gain is practically always among the first twelve,
/// and the cost remains that of matrix products.
inline constexpr int kProfiled = 12;

/// Gain of every contender on the table, and greatest gains on tables drawn from the null model.
struct GainDistribution {
  std::vector<double> gain;         ///< of each contender, in their order
  std::vector<double> greatest;     ///< of each drawn table, ascending
  double null_score = 0.0;          ///< score of the table under the null model: held-out log-likelihood plus
                                    ///< prior
  RunError run = RunError::Zero();  ///< covariance of a run's error under the null model
  /// Logarithm of the ratio of tests on the table to tests on the drawn tables. A log-likelihood ratio of
  /// noise exceeds x with a probability of order e^-x (Wilks). With N times as many tests, the gain exceeds x
  /// + ln N with about the same probability (Bonferroni).
  double further_questions = 0.0;

  /// Returns the gain that drawn tables exceed with probability `level`.
  double threshold(double level) const;
  /// Returns the share of tables that reach this gain. The measured table counts as one of the tables, so
  /// that the share is at least 1 / (draws + 1).
  double pValue(double reached) const;
};

/// Reference of the gains: the current model on whitened rows.
struct NullModel {
  std::vector<SharedFactor> factor;  ///< effect of a shared error on each row
  std::vector<int> unit;             ///< run number of each row, from 0; empty: rows share no error
  Folds folds;                       ///< rows held out together
  Eigen::VectorXd residual;          ///< whitened, rows*kChannels
  LinearModel known;                 ///< derivatives by the free parameters
  RunError run_start;                ///< start of the search for the covariance of a run's error
  Eigen::Index soil = 0;             ///< number of leading columns of `known` that belong to the soil
};

/// Indexed contenders; each is requested once.
struct Contenders {
  std::size_t count = 0;
  std::function<Contender(std::size_t)> at;
};

/// A gain is the increase of the held-out log-likelihood when a contender is added, plus the change of the
/// prior term through the other parameters. The covariance of a run's error is profiled under both models.
/// `draws` tables are drawn from the null model: the current model with a soil drawn from its prior (the
/// fitted soil may be unrealistic if an effect is missing), errors of unit variance and errors of the runs'
/// covariance. `go_on` receives the completed share; after a return value of false the remaining gains are 0.
GainDistribution gainDistribution(const NullModel& null, const Contenders& contenders, int draws,
                                  std::uint64_t seed, const std::function<bool(double)>& go_on);

/// Maximum-likelihood covariance of a run's error under a model.
RunError runErrorOf(const NullModel& null);

/// Returns the score of a fitted model, comparable to null_score, from its residuals and derivatives. The
/// covariance of a run's error is profiled, starting from that of the null model.
double fittedScore(const NullModel& fitted);

}  // namespace talus::terramech
