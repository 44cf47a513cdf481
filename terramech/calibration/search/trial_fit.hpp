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

/// Fits a model to rows, and scores other models on the same rows with the same noise.
class TrialFit {
 public:
  /// Estimates the noise for `base` and fits its free parameters, or the whole soil if `fit_soil`. `go_on` is
  /// called before each round of the fit; false ends the fit.
  TrialFit(const RefinedModel& base, const Trial& trial, bool fit_soil,
           const std::function<bool(double)>& go_on);

  const RefinedModel& model() const { return model_; }
  const CalibratedRows& rows() const { return rows_; }
  const SolvedContacts& solved() const { return solved_; }

  /// Sets a prior for the first parameter of the first effect after those of the base.
  void trust(const std::optional<Estimate>& prior) { first_prior_ = prior; }

  /// Fits another model to the rows with unchanged noise.
  Fit fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const;

  /// The model of fit(), started from the present solutions.
  RefinedModel fitted(const RefinedModel& model, int iterations) const;

  /// Linearises another model on the rows.
  NullModel standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                     SolvedContacts& solved) const;

  /// Score of a fitted model with unchanged noise.
  double scoreOf(const RefinedModel& fitted) const;

  /// Replaces the model with unchanged noise.
  void setModel(const RefinedModel& model);

  /// Re-estimates the noise.
  void refresh();

  /// Sets the model, then fits all parameters and re-estimates the noise, twice.
  void settle(const RefinedModel& start);

  /// Sets the free parameters of the model and their covariance, after another fit of all parameters if
  /// `again` is true. Returns the covariance.
  Eigen::MatrixXd finish(bool again);

  /// The channel in which the removal of an effect changes the predictions most, relative to the noise.
  Channel strongest(std::size_t effect) const;

  /// noiseFloor() of the model with this noise, at slip and load as measured.
  std::array<double, kChannels> noiseFloor(const SensorNoise& noise);

 private:
  void refit(int iterations);
  FitPlan planFor(const RefinedModel& model) const;
  void fitSoil(const std::function<bool(double)>& go_on);
  void setRows(const Trial& trial);

  bool fit_soil_;
  RefinedModel model_;
  int given_effects_;     ///< number of leading effects, those of the base
  double prior_modulus_;  ///< k_c + k_phi of the base, reference of log_stiffness
  CalibratedRows rows_;
  Folds folds_;
  SolvedContacts solved_;
  double misfit_ = 1.0;  ///< as FitPlan::misfit
  std::optional<Estimate> first_prior_;
};

}  // namespace talus::terramech
