#pragma once

#include <optional>
#include <vector>

#include <terramech/residual_trace.hpp>

namespace talus::terramech {

/// The state of one search: a model that grows, the rows, and what is known of their noise. Used by
/// traceResiduals().
class TraceSearch {
 public:
  TraceSearch(const RefinedModel& base, const Trial& trial, const TraceOptions& options);

  const RefinedModel& model() const { return model_; }

  /// A candidate tried to first order.
  struct Screened {
    Candidate candidate;        ///< empirical ones only with the channels that pay
    Eigen::MatrixXd direction;  ///< whitened change of the readings
    double score = 0.0;
  };

  /// All candidates by the log-likelihood that they would gain to first order, less their penalty; best
  /// first.
  std::vector<Screened> screen();

  /// Whether the residuals hold anything at all.
  std::vector<CovariateTest> test(const std::vector<Screened>& screened);

  /// The most promising candidates fitted inside the full model, best first.
  std::vector<Explanation> fitBest(const std::vector<Screened>& screened,
                                   const std::vector<CovariateTest>& tests);

  /// Which of the ranked is believed: the best known form unless a curve says clearly more; none when nothing
  /// pays.
  std::optional<std::size_t> choose(const std::vector<Explanation>& ranked) const;

  /// Puts a candidate into the model, fits everything again and finds the noise anew.
  void accept(const Candidate& candidate);

  /// What would explain the rows in place of accepted candidate number k, the others kept and the noise as it
  /// is now known: before the first effect was in, the noise was only guessed.
  std::vector<Explanation> rivals(std::size_t k);

  /// Takes accepted candidate number k out and puts another in, which becomes the last.
  void replace(std::size_t k, const Candidate& candidate);

  /// Fills the result's model, errors and standard deviations.
  void finish(TraceResult& result);

 private:
  void refresh();
  void takeOut(std::size_t k);
  void fitSoil();
  FitPlan planFor(const RefinedModel& model) const;
  Explanation fitted(const Candidate& candidate);
  double penalty(const Candidate& candidate) const;
  Eigen::VectorXd sinkages(const Eigen::MatrixXd& level) const;
  Screened screenLibrary(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Screened screenSoilCurve(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Screened screenCurves(const Candidate& candidate, const Eigen::MatrixXd& nuisance);
  Eigen::VectorXd change(const RefinedModel& moved);

  TraceOptions options_;
  RefinedModel model_;
  Trial trial_;
  std::vector<double> guesses_;
  Eigen::MatrixXd level_, residual_;
  Whitening whitening_;
  Eigen::VectorXd white_;
  std::vector<int> group_;
  std::vector<std::size_t> part_count_;  ///< effects in the model of each accepted candidate
};

}  // namespace talus::terramech
