#pragma once

#include <optional>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

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

  Trial trial_;
  Eigen::MatrixXd level_, residual_;
  std::optional<Eigen::MatrixXd> by_slip_;
  Whitening whitening_;
  Eigen::VectorXd white_;
};

}  // namespace talus::terramech
