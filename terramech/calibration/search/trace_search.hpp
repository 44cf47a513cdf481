#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>

namespace talus::terramech {

/// One search: candidates compared beside a model that grows by those accepted. Used by traceResiduals().
class TraceSearch {
 public:
  /// `go_on` is asked between pieces of work with the share that is done; false ends each call early.
  TraceSearch(
      const RefinedModel& base, const Trial& trial, const TraceOptions& options,
      std::function<bool(double)> go_on = [](double) { return true; });

  const RefinedModel& model() const { return fit_.model(); }

  /// All candidates to first order, and what tables drawn from the model would promise.
  struct Screening {
    std::vector<Promise> promises;  ///< best first
    double threshold = 0.0;
    double p_value(double gain) const { return noise.pValue(gain); }
    GainDistribution noise;
  };
  Screening screen(int draws);

  /// Gains of candidates to first order, in their order.
  std::vector<double> gainsOf(const std::vector<Candidate>& candidates);

  /// The most promising candidates fitted inside the full model, by the same gain, best first.
  std::vector<Explanation> fitBest(const std::vector<Promise>& promises);

  /// A candidate fitted together with everything else.
  Explanation fitted(const Candidate& candidate);

  /// The model with a candidate, fitted, with the covariance of its parameters.
  RefinedModel modelWith(const Candidate& candidate) const;

  /// Whether what a model predicts depends on a column: rows that exchange their values of it (the first with that in the
  /// middle, and so on) differ by more than closeGain() in log-likelihood.
  bool dependsOn(const RefinedModel& model, const std::string& column) const;

  /// What two candidates together gain, the first fitted before the second is sought, best first.
  std::vector<Explanation> pairs();

  /// Puts a candidate into the model, fits everything again and estimates the noise again.
  void accept(const Candidate& candidate);

  /// Keeps the first parameter of the effect accepted first near what was known of it before.
  void trust(const std::optional<Estimate>& prior);

  /// Takes accepted candidate number k out and fits the others again, the noise as it is.
  void leaveOut(std::size_t k);

  /// Fits everything and estimates the noise again.
  void settleAll();

  /// What accepted candidate number k gains beside the others, the noise as it is.
  double gainOf(std::size_t k) const;

  /// What part `part` of accepted candidate number k gains beside everything else, the noise as it is.
  double gainOfPart(std::size_t k, std::size_t part) const;

  /// Whether accepted candidate number k moves the readings of the rows, in any channel by a fiftieth of their
  /// noise, root mean square: less would gain closeGain() in no table that is searched.
  bool acts(std::size_t k) const;

  /// Takes those parts out of accepted candidate number k, last first, that gain no more than `least`; one stays.
  void thin(std::size_t k, double least);

  /// Takes those parts out of it that move nothing, as acts(), whatever they gain: a form at its bound may gain by what it
  /// would do beyond it, to first order. One stays.
  void dropIdleParts(std::size_t k);

  /// The effects of accepted candidate number k as they are now in the model.
  std::vector<Effect> parts(std::size_t k) const;

  /// What the rows of a run have in common beside the model.
  const SharedError& sharedError() const { return fit_.rows().whitening().common; }

  /// Squared length of the whitened residuals.
  double chi2() const { return fit_.rows().white().squaredNorm(); }

  /// Gives curves more knots where that gains.
  void refineCurves();

  /// Fills the result's model, errors and standard deviations.
  void finish(TraceResult& result);

 private:
  GainDistribution distributionOf(const std::vector<Candidate>& candidates, int draws) const;
  bool refineCurve(std::size_t k);
  RefinedModel withoutPart(std::size_t k, std::size_t part) const;
  /// Whether the readings of the rows differ without an effect, as acts().
  bool differs(const RefinedModel& without) const;
  std::size_t firstPart(std::size_t k) const;  ///< of accepted candidate number k among the model's effects
  /// Sets the parameters, their standard deviations and the channel of each effect.
  void describe(std::vector<TracedEffect>& effects, const Eigen::MatrixXd& covariance) const;

  TraceOptions options_;
  std::function<bool(double)> go_on_;
  TrialFit fit_;
  std::optional<Estimate> first_prior_;  ///< of a correction that is never taken out
  std::size_t given_effects_;            ///< of the base, in front; fitted, never taken out
  std::vector<std::size_t> part_count_;  ///< effects in the model of each accepted candidate
};

}  // namespace talus::terramech
