#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/nominal_load.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Rows of a trial relative to a model: most likely slip and load, residuals, and noise estimated from the
/// residuals. `solved` as in predictRows().
class CalibratedRows {
 public:
  explicit CalibratedRows(const Trial& trial) : trial_(trial) {}

  /// Estimates the noise from the residuals of `model` without their smooth dependence on columns, writes it
  /// to model.noise, and calibrates slip and load. The shared error of units starts at roughRunError().
  void calibrate(RefinedModel& model, SolvedContacts& solved);

  /// Sets the covariance of the error shared by rows of a unit.
  void setRunError(const RunError& run);

  /// Replaces the residuals by those of another model, with unchanged noise.
  void compare(const RefinedModel& model, SolvedContacts& solved);

  const Trial& trial() const { return trial_; }
  const Eigen::MatrixXd& level() const { return level_; }        ///< predictions, rows x kChannels
  const Eigen::MatrixXd& residual() const { return residual_; }  ///< measured - level
  const Whitening& whitening() const { return whitening_; }
  const Eigen::VectorXd& white() const { return white_; }  ///< whitened residuals, rows*kChannels

  /// Change of the predictions for one standard deviation of the slip error shared by all rows; nullopt if
  /// rows vary in slip and in speed.
  const std::optional<Eigen::MatrixXd>& bySharedSlip() const { return by_slip_; }

  Eigen::VectorXd sinkages_m() const;  ///< sinkages of the model

 private:
  void backToMeasured();
  void findSetLoads(const Eigen::MatrixXd& measured, const InputSlopes& slopes);
  StatedSensors knownSensors(const RefinedModel& model) const;
  /// Fits the noise to residuals that contain only noise, at the measured inputs, and updates all dependent
  /// quantities.
  void settle(const Eigen::MatrixXd& noise_alone, const Eigen::MatrixXd& level,
              const InputSlopes& measured_slopes, RefinedModel& model, SolvedContacts& solved);
  /// Determines the units (groups of rows with a shared error), and the noise without the shared error.
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
