#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>

/// Reduces a large table to a size that a search for effects can process in bounded time.
namespace talus::terramech {

/// Search of traceResiduals(). The search compares candidates (possible additions to a wheel model) and adds
/// accepted candidates to the model. A candidate has one or more parts, each of which is an effect.
class TraceSearch {
 public:
  /// `go_on` is called between steps of work with the completed share; a return value of false ends the call
  /// early.
  TraceSearch(
      const RefinedModel& base, const Trial& trial, const TraceOptions& options,
      std::function<bool(double)> go_on = [](double) { return true; });

  const RefinedModel& model() const { return fit_.model(); }

  /// Linearised gains of all candidates, and the distribution of gains under noise.
  struct Screening {
    std::vector<Promise> promises;  ///< candidates, best first
    double threshold = 0.0;         ///< gain that noise exceeds with probability `significance`
    double p_value(double gain) const { return noise.pValue(gain); }
    GainDistribution noise;
  };
  /// Returns the linearised gains, with a distribution from `draws` drawn tables.
  Screening screen(int draws);

  /// Returns the linearised gains of the candidates, in their order.
  std::vector<double> gainsOf(const std::vector<Candidate>& candidates);

  /// Fits the most promising candidates inside the full model. Returns the fitted candidates, best gain
  /// first.
  std::vector<Explanation> fitBest(const std::vector<Promise>& promises) const;

  /// Returns a candidate fitted together with all other parameters.
  Explanation fitted(const Candidate& candidate) const;

  /// Returns the fitted model with a candidate, including the covariance of its parameters.
  RefinedModel modelWith(const Candidate& candidate) const;

  /// Returns true if the predictions of a model depend on a column: an exchange of the column's values among
  /// rows (the first with the middle row, and so on) changes the log-likelihood by more than closeGain().
  bool dependsOn(const RefinedModel& model, const std::string& column) const;

  /// Adds a candidate to the model, refits all parameters and estimates the noise again. Forms that were
  /// found together become one accepted candidate each.
  void accept(const Candidate& candidate);

  /// Removes accepted candidate number k and refits the others with unchanged noise.
  void leaveOut(std::size_t k);

  /// Refits all parameters and estimates the noise again.
  void settleAll();

  /// Returns the gain of accepted candidate k relative to the model without candidate k, with unchanged
  /// noise and including Candidate::logPrior().
  double gainOf(std::size_t k) const;

  /// Returns gainOf(k) from a search without accepted candidate k.
  double gainOver(const TraceSearch& without, std::size_t k) const;

  /// Returns the current effects of accepted candidate k in the model.
  std::vector<Effect> parts(std::size_t k) const;

  /// Returns the error shared by the rows of a run.
  const SharedError& sharedError() const { return fit_.rows().whitening().common; }

  /// Returns the squared norm of the whitened residuals.
  double chi2() const { return fit_.rows().white().squaredNorm(); }

  /// Writes the model, its errors and standard deviations to the result.
  void finish(TraceResult& result);

 private:
  Explanation fitted(const Candidate& candidate, double before) const;
  GainDistribution distributionOf(const std::vector<Candidate>& candidates, int draws) const;
  std::size_t firstPart(std::size_t k) const;  ///< index of the first effect of candidate k in the model
  /// Sets the parameters, their standard deviations and the channel of each found effect.
  void describe(std::vector<TracedEffect>& effects, const Eigen::MatrixXd& covariance) const;

  TraceOptions options_;
  std::function<bool(double)> go_on_;
  TrialFit fit_;
  /// Number of leading effects, those of the base model. These effects are fitted, never removed.
  std::size_t given_effects_;
  struct Unit {
    std::size_t parts;  ///< number of effects
    double log_prior;
  };
  std::vector<Unit> units_;  ///< accepted candidates
};

/// Explanations in the place of an accepted candidate.
struct Replacements {
  TraceSearch without;              ///< search without the accepted candidate
  std::vector<Explanation> ranked;  ///< the most promising candidates, fitted, best gain first
};

/// Screens and fits the candidates in the place of accepted candidate `k`. Their gains are comparable to
/// TraceSearch::gainOf(k).
Replacements replacementsOf(const TraceSearch& search, std::size_t k);

/// Returns alternative causes from `ranked` in the place of an accepted candidate with the effects `own`, or in
/// addition to the model if `own` is empty. Returns at most three causes of different columns or forms, best
/// first.
std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked,
                                 const std::vector<Effect>& own);

/// Marks a random sample of at most `most` rows. The rows, in order of runs and of the file, are divided into
/// `most` equal stretches, and one row of each stretch is drawn. Every run thereby keeps its share, and
/// periods of the experiment are not aliased. For a rover's own drive, whole moments (rows of all wheels at
/// one time) are drawn.
std::vector<char> rowSample(const Trial& trial, int most, std::uint64_t seed);

/// Returns the trial with at most options.most_columns additional columns (columns unknown to Talus), numeric
/// and text together, in the order of the table. The kept columns are those with the greatest gain of
/// coarseCandidates() on the residuals of `base`. The other columns are listed in Trial::dropped and removed
/// from the states. Kept columns with a gain up to ln(columns / significance) are listed in Trial::chance,
/// because noise reaches this gain in some column with a probability of at most `significance`. `go_on`
/// receives the completed share; a return value of false ends the screening.
Trial screenColumns(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                    const std::function<bool(double)>& go_on);

}  // namespace talus::terramech
