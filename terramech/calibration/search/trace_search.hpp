#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/calibration/fit/candidate_columns.hpp>
#include <talus/terramech/calibration/noise/nominal_load.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// The state of one search: a model that grows, the rows, and what is known of their noise. Used by
/// traceResiduals().
class TraceSearch {
 public:
  /// `go_on` is asked between pieces of work with the share that is done; false ends each call early.
  TraceSearch(
      const RefinedModel& base, const Trial& trial, const TraceOptions& options,
      std::function<bool(double)> go_on = [](double) { return true; });

  const RefinedModel& model() const { return model_; }

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

  /// What two candidates together gain, the first fitted before the second is sought, best first.
  std::vector<Explanation> pairs();

  /// Puts a candidate into the model, fits everything again and estimates the noise again.
  void accept(const Candidate& candidate);

  /// Keeps the first parameter of the effect accepted first near what was known of it before.
  void trust(const std::optional<Estimate>& prior) { first_prior_ = prior; }

  /// Takes accepted candidate number k out and fits the others again, the noise as it is.
  void leaveOut(std::size_t k);

  /// Fits everything and estimates the noise again.
  void settleAll();

  /// What accepted candidate number k gains beside the others, the noise as it is.
  double gainOf(std::size_t k);

  /// Takes those parts out of accepted candidate number k, last first, without which the score is no worse; one
  /// stays.
  void thin(std::size_t k);

  /// The effects of accepted candidate number k as they are now in the model.
  std::vector<Effect> parts(std::size_t k) const;

  /// What the rows of a run have in common beside the model.
  SharedError sharedError() const { return {whitening_.unit, whitening_.run}; }

  /// Squared length of the whitened residuals.
  double chi2() const { return white_.squaredNorm(); }

  /// Gives curves more knots where that gains.
  void refineCurves();

  /// Fills the result's model, errors and standard deviations.
  void finish(TraceResult& result);

 private:
  void refresh();
  GainDistribution distributionOf(const std::vector<Candidate>& candidates, int draws);
  void backToMeasured();
  void findSetLoads(const Eigen::MatrixXd& measured, const InputSlopes& slopes);
  StatedSensors knownSensors() const;  ///< the load cell's error where the set loads show it
  /// Fits the noise to residuals that hold nothing else, at the measured inputs, and all that follows from
  /// it.
  void settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
              const InputSlopes& measured_slopes);
  /// Finds what rows of a run or of a stretch of time share, and the noise without it.
  void shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level, const InputSlopes& measured_slopes);
  Channel strongest(std::size_t effect);  ///< where taking it out, all else left, changes most [noise]

  void fitSoil();
  FitPlan planFor(const RefinedModel& model) const;
  Fit fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const;
  std::size_t firstPart(std::size_t k) const;  ///< of accepted candidate number k among the model's effects
  Eigen::VectorXd sinkages() const;
  void setModel(const RefinedModel& model);  ///< the noise as it is
  /// A model as it stands on the rows, to first order.
  NullModel standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                     SolvedContacts& solved) const;
  /// The score of a fitted model under the noise as it is.
  double scoreOf(const RefinedModel& fitted) const;

  TraceOptions options_;
  std::function<bool(double)> go_on_;
  RefinedModel model_;
  double prior_modulus_;  ///< k_c + k_phi of the base, that its log_stiffness counts from
  Trial trial_;
  Folds folds_;
  SolvedContacts solved_;
  Eigen::MatrixXd level_, residual_;
  std::optional<Eigen::MatrixXd> by_slip_;  ///< change by one std of the error that all slips share, where
                                            ///< there is one level of slip or one speed
  std::optional<NominalLoad> set_load_;
  Whitening whitening_;
  Eigen::VectorXd white_;
  double misfit_ = 1.0;                  ///< as FitPlan's
  std::optional<Estimate> first_prior_;  ///< of a correction that is never taken out
  std::size_t given_effects_;            ///< of the base, in front; fitted, never taken out
  std::vector<std::size_t> part_count_;  ///< effects in the model of each accepted candidate
};

}  // namespace talus::terramech
