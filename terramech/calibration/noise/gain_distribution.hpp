#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

namespace talus::terramech {

/// Something that may be added to a model.
struct Contender {
  LinearModel added;
  bool positive = false;  ///< its first step may not be below 0
};

/// How many of the contenders with the greatest gain at the null's run error are profiled in a drawn table: the
/// greatest is practically always among them, and the cost stays that of matrix products.
inline constexpr int kProfiled = 12;

/// The gain of every contender on the table, and the greatest gain on tables drawn from the null.
struct GainDistribution {
  std::vector<double> gain;         ///< of each contender, in their order
  std::vector<double> greatest;     ///< of each drawn table, ascending
  double null_score = 0.0;          ///< of the table under the null: log-likelihood held out and prior
  RunError run = RunError::Zero();  ///< covariance of a run's error under the null
  /// Logarithm of how many times more questions were put to the table than to the drawn ones. A log-likelihood ratio of
  /// noise exceeds x with probability of order e^-x (Wilks), so that N times the questions reach the gain x + ln N as
  /// often as one time reaches x (Bonferroni).
  double further_questions = 0.0;

  /// Gain that drawn tables exceed with probability `level`.
  double threshold(double level) const;
  /// Share of drawn tables that reach this gain, the table itself counted among them: at least 1 / (draws + 1).
  double pValue(double reached) const;
};

/// What the gains are counted from: a model as it stands on whitened rows.
struct NullModel {
  std::vector<SharedFactor> factor;  ///< what an error that rows share becomes in each
  std::vector<int> unit;             ///< run of each row, from 0; empty: rows share nothing
  Folds folds;                       ///< held out together
  Eigen::VectorXd residual;          ///< whitened, rows*kChannels
  LinearModel known;                 ///< what the model lets a fit move
  RunError run_start;                ///< of a run's error, where the search for its covariance starts
  Eigen::Index soil = 0;             ///< steps of `known`, in front, that are the soil's
};

/// Contenders by number, each asked for once.
struct Contenders {
  std::size_t count = 0;
  std::function<Contender(std::size_t)> at;
};

/// A gain: how much the log-likelihood on held-out rows rises when a contender is added, with the share of the
/// prior that the other parameters regain; the covariance of a run's error is profiled under either model.
/// `draws` tables come from the null: the model as it stands but for a soil drawn from its prior (a soil that rows
/// without an effect moved far from its prior does not exist), errors of unit variance and of the runs' covariance. `go_on` receives the share that is done; false leaves the rest at gain 0.
GainDistribution gainDistribution(const NullModel& null, const Contenders& contenders, int draws,
                                  std::uint64_t seed, const std::function<bool(double)>& go_on);

/// The most likely covariance of a run's error under a model.
RunError runErrorOf(const NullModel& null);

/// Score of a model that was fitted, comparable to null_score: its own residual and derivatives, the run's error
/// profiled from that of the null.
double fittedScore(const NullModel& fitted);

}  // namespace talus::terramech
