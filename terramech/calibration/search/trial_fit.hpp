#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/noise/gain_distribution.hpp>
#include <talus/terramech/calibration/search/calibrated_rows.hpp>

namespace talus::terramech {

/// A model fitted to rows, and the score of others on the same rows under the same noise.
class TrialFit {
 public:
  /// Estimates the noise beside `base` and fits what it lets a fit move, the whole soil where `fit_soil`. `go_on` is asked
  /// before each round of that fit; false ends it.
  TrialFit(const RefinedModel& base, const Trial& trial, bool fit_soil,
           const std::function<bool(double)>& go_on);

  const RefinedModel& model() const { return model_; }
  const CalibratedRows& rows() const { return rows_; }
  const SolvedContacts& solved() const { return solved_; }

  /// Keeps the first parameter of the first effect behind the base's near what was known of it before.
  void trust(const std::optional<Estimate>& prior) { first_prior_ = prior; }

  /// Another model fitted to the rows, the noise as it is.
  Fit fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const;

  /// The model of that fit, started from what was solved for this one.
  RefinedModel fitted(const RefinedModel& model, int iterations) const;

  /// Another model as it stands on the rows, to first order.
  NullModel standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                     SolvedContacts& solved) const;

  /// The score of a fitted model under the noise as it is.
  double scoreOf(const RefinedModel& fitted) const;

  /// Replaces the model, the noise as it is.
  void setModel(const RefinedModel& model);

  /// Estimates the noise again.
  void refresh();

  /// Starts from another model, then fits everything and estimates the noise again, twice.
  void settle(const RefinedModel& start);

  /// Fits everything once more where `again`, and sets the model's free parameters and their covariance, which it
  /// returns.
  Eigen::MatrixXd finish(bool again);

  /// The channel in which the rows change most, over their noise, when one effect of the model is taken out.
  Channel strongest(std::size_t effect) const;

  /// noiseFloor() of the model under this noise, at slip and load as measured.
  std::array<double, kChannels> noiseFloor(const SensorNoise& noise);

 private:
  void refit(int iterations);
  FitPlan planFor(const RefinedModel& model) const;
  void fitSoil(const std::function<bool(double)>& go_on);
  void setRows(const Trial& trial);

  bool fit_soil_;
  RefinedModel model_;
  int given_effects_;     ///< of the base, in front
  double prior_modulus_;  ///< k_c + k_phi of the base, that its log_stiffness counts from
  CalibratedRows rows_;
  Folds folds_;
  SolvedContacts solved_;
  double misfit_ = 1.0;  ///< as FitPlan's
  std::optional<Estimate> first_prior_;
};

}  // namespace talus::terramech
