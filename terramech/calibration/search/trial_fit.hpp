#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Returns a model with the prior information on a rover's own drive, and the given model for other tables.
/// The pull of a drive follows from the slope and has the error of an inclinometer, 0.3 degrees unless stated
/// (ours). Wheels behind another wheel drive in a rut (rut.hpp), whose stiffness is fitted.
RefinedModel asDriven(RefinedModel model, const Trial& trial);

/// Rows of a trial (table of measured rows) relative to a wheel model: most likely slip and load of each row,
/// residuals, and sensor noise estimated from the residuals. Arguments named `solved` are the cache of
/// predictRows().
class CalibratedRows {
 public:
  explicit CalibratedRows(const Trial& trial) : trial_(trial) {}

  /// Estimates the sensor noise from the residuals of `model`, writes it to model.noise, and then estimates
  /// the true slip and load of each row. The smooth dependence of the residuals on columns is removed first.
  /// The covariance of the error shared by a unit (group of rows, such as a run) starts at roughRunError().
  void calibrate(RefinedModel& model, SolvedContacts& solved);

  /// Sets the covariance of the error that the rows of a unit share.
  void setRunError(const RunError& run);

  /// Replaces the residuals by those of another model. The noise remains unchanged.
  void compare(const RefinedModel& model, SolvedContacts& solved);

  const Trial& trial() const { return trial_; }
  const Eigen::MatrixXd& level() const { return level_; }        ///< predictions, rows x kChannels
  const Eigen::MatrixXd& residual() const { return residual_; }  ///< measured - level
  const Whitening& whitening() const { return whitening_; }
  const Eigen::VectorXd& white() const { return white_; }  ///< whitened residuals, rows*kChannels

  /// Returns the change of the predictions for one standard deviation of the slip error that all rows share.
  /// Returns nullopt if the slip errors are independent, i.e. if both slip and speed vary over the rows.
  const std::optional<Eigen::MatrixXd>& bySharedSlip() const { return by_slip_; }

  Eigen::VectorXd sinkages_m() const;  ///< returns the sinkage of the model in each row

 private:
  void backToMeasured();
  StatedSensors knownSensors(const RefinedModel& model) const;
  /// Fits the noise to residuals at the measured inputs that contain only noise, and updates all dependent
  /// quantities.
  void settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
              const InputSlopes& measured_slopes, RefinedModel& model, SolvedContacts& solved);
  /// Determines the units (groups of rows that share an error), and the noise without the shared error.
  void shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level, const InputSlopes& measured_slopes,
                   RefinedModel& model, SolvedContacts& solved);

  /// Determines whether the scatter of the loads about set loads is an error.
  void findSetLoads(const RefinedModel& model, const Eigen::MatrixXd& measured, SolvedContacts& solved);

  Trial trial_;
  std::optional<SetLoads> set_;  // empty: the loads are as measured
  Eigen::MatrixXd level_, residual_;
  std::optional<Eigen::MatrixXd> by_slip_;
  Whitening whitening_;
  Eigen::VectorXd white_;
};

/// Fits a wheel model to the rows of a trial, and scores other models on the same rows with the same sensor
/// noise.
class TrialFit {
 public:
  /// Estimates the noise for `base` and fits its free parameters, or all soil parameters if `fit_soil` is
  /// true. `go_on` is called before each round of the fit; a return value of false ends the fit. If
  /// `fit_effects` is false, the effects of the models are known and not fitted.
  TrialFit(const RefinedModel& base, const Trial& trial, bool fit_soil,
           const std::function<bool(double)>& go_on, bool fit_effects = true);

  const RefinedModel& model() const { return model_; }
  const CalibratedRows& rows() const { return rows_; }
  const SolvedContacts& solved() const { return solved_; }

  /// Fits another model to the rows with unchanged noise.
  Fit fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const;

  /// Returns the model of fit(), with the present contact solutions as initial values.
  RefinedModel fitted(const RefinedModel& model, int iterations) const;

  /// Linearises a model, which may differ from the present one, about its predictions for the rows. The result
  /// is a null model for gainDistribution().
  NullModel standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                     SolvedContacts& solved) const;

  /// Returns the score (held-out log-likelihood plus prior term) of a fitted model, with unchanged noise.
  /// Parameters of effects at a bound of their range are fixed there.
  double scoreOf(const RefinedModel& fitted) const;

  /// Replaces the model. The noise remains unchanged.
  void setModel(const RefinedModel& model);

  /// Estimates the noise again.
  void refresh();

  /// Sets the model, and then twice fits all parameters and estimates the noise.
  void settle(const RefinedModel& start);

  /// Sets the free parameters of the model and their covariance. If `again` is true, all parameters are
  /// fitted once more before. Returns the covariance.
  Eigen::MatrixXd finish(bool again);

  /// Returns the channel in which the removal of `count` effects from `effect` on changes the predictions most,
  /// relative to the noise.
  Channel strongest(std::size_t effect, std::size_t count) const;

  /// Returns noiseFloor() of the model for the given sensor noise, at slip and load as measured.
  std::array<double, kChannels> noiseFloor(const SensorNoise& noise);

 private:
  FitPlan planFor(const RefinedModel& model) const;
  void fitSoil(const std::function<bool(double)>& go_on);
  void setRows(const Trial& trial);
  NullModel standing(const RefinedModel& model, const FitPlan& plan, const Eigen::MatrixXd& residual,
                     SolvedContacts& solved) const;

  bool fit_soil_, fit_effects_;
  RefinedModel model_;
  double prior_modulus_;  ///< k_c + k_phi of the base model, at which log_stiffness is 0
  CalibratedRows rows_;
  Folds folds_;
  SolvedContacts solved_;
  double misfit_ = 1.0;  ///< value of FitPlan::misfit
};

}  // namespace talus::terramech
