#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/nominal_load.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Rows of a trial beside a model: slip and load at their most likely values, the residuals, and the noise that these
/// show. `solved` as predictRows().
class CalibratedRows {
 public:
  explicit CalibratedRows(const Trial& trial) : trial_(trial) {}

  /// Estimates the noise from the residuals of `model` less every smooth dependence on a column, writes it to model.noise,
  /// and calibrates slip and load by it. The error that rows of a unit share starts at roughRunError().
  void calibrate(RefinedModel& model, SolvedContacts& solved);

  /// Replaces the covariance of the error that rows of a unit share.
  void setRunError(const RunError& run);

  /// Residuals of another model, the noise as it is.
  void compare(const RefinedModel& model, SolvedContacts& solved);

  const Trial& trial() const { return trial_; }
  const Eigen::MatrixXd& level() const { return level_; }        ///< the model's readings, rows x kChannels
  const Eigen::MatrixXd& residual() const { return residual_; }  ///< measured - level
  const Whitening& whitening() const { return whitening_; }
  const Eigen::VectorXd& white() const { return white_; }  ///< whitened residuals, rows*kChannels

  /// Change of the readings by one standard deviation of the error that all slips share; empty where rows vary in slip and
  /// in speed.
  const std::optional<Eigen::MatrixXd>& bySharedSlip() const { return by_slip_; }

  Eigen::VectorXd sinkages_m() const;  ///< the model's

 private:
  void backToMeasured();
  void findSetLoads(const Eigen::MatrixXd& measured, const InputSlopes& slopes);
  StatedSensors knownSensors(const RefinedModel& model) const;
  /// Fits the noise to residuals that hold nothing else, at the measured inputs, and all that follows from it.
  void settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
              const InputSlopes& measured_slopes, RefinedModel& model, SolvedContacts& solved);
  /// Finds the units whose rows share an error, and the noise without it.
  void shareWithin(Eigen::MatrixXd smooth, const Eigen::MatrixXd& level, const InputSlopes& measured_slopes,
                   RefinedModel& model, SolvedContacts& solved);

  Trial trial_;
  Eigen::MatrixXd level_, residual_;
  std::optional<Eigen::MatrixXd> by_slip_;
  std::optional<NominalLoad> set_load_;
  Whitening whitening_;
  Eigen::VectorXd white_;
};

}  // namespace talus::terramech
