#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {

/// Estimates the soil from plate tests by method bevameter. Throws the exceptions of estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Estimates the soil by one of the linear methods sojourner, iagnemma and linear-offset. Throws the
/// exceptions of estimateSoil().
SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Table of wheel telemetry with the model of its rows.
struct TableRows {
  RefinedModel
      model;    ///< options.model with the wheel of options.rover; without a file the model of unknown soil
  Trial trial;  ///< rows above the axle, at most a thousand (rowSample())
  std::vector<RejectedRow> rejected;
  std::vector<std::string> warnings;  ///< rows that are not in `trial`
};

/// Reads a table for the fit of a soil. Throws InputError for invalid input, for a model without a soil, and if
/// the sinkage of every row reaches the axle.
TableRows tableRows(const TableFile& table, const std::string& model, const std::string& rover,
                    const ProgressMonitor& watch);

/// Estimates the soil by method wong-reece from all channels of the table, with the effects of options.model
/// if given. Throws the exceptions of estimateSoil(), and std::domain_error if the strength is that of no soil
/// (SoilEstimate::implausible()) or if the nearest soil leaves more than half of a column unexplained.
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Options for a fit of the soil under a wheel model.
struct ModelSoilOptions {
  /// Equally probable soils with their standard deviations; empty: the vague prior of fitPlan().
  std::vector<SoilPrior> prior;
  std::optional<double> shear_modulus_m;  ///< stated K [m], which is then not fitted; empty: K is fitted
  double noise = 0.0;  ///< relative error of the sensors whose error is not stated [-]; 0: estimated
};

/// Soil estimate with its uncertainty.
struct ModelSoil {
  /// Given model with the estimated soil, and with the covariance of its parameters, including priors.
  RefinedModel model;
  std::vector<double> probability;  ///< probability of each soil of the prior
  /// Mean square of the residuals over the stated errors [-], about 1 if model and errors are correct. Unless stated,
  /// the errors are 5 % of a reading, or of the mean load for a pull or side force, which may be zero. The fit uses errors that are estimated from the rows.
  double misfit = 0.0;
  Channel worst = Channel::Torque;  ///< channel with the greatest part of the misfit
  /// Parameters whose uncertainty is that of the prior, or that are at a bound of their range.
  std::vector<std::string> unseen;

  Eigen::Matrix2d strengthCovariance() const;      ///< returns the covariance of (c [Pa], tan phi)
  double std(const std::string& parameter) const;  ///< returns the standard deviation of a soil parameter
};

/// Returns the soil for the rows of a trial from all measured channels, by the likelihood of traceResiduals(): the
/// errors of the sensors, and slip and load of each row, are estimated under the vague prior (TrialFit). The
/// effects of `model` are known; their contribution is not attributed to the soil. Each soil of the prior is then
/// fitted with the same errors; its posterior is normal about its mode, and its weight is its evidence (Laplace).
/// The result has mean and covariance of the mixture.
ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options = {},
                    const ProgressMonitor& watch = {});

}  // namespace talus::terramech
