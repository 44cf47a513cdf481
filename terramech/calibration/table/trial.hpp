#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Measured rows for residual tracing. Columns of `measured` are the scaled channels in the order of Channel;
/// NaN = missing.
struct Trial {
  std::vector<WheelState> states;  ///< slip and load are estimates after calibration of the inputs
  std::vector<double> load_N;      ///< as measured; denominator of every ratio
  std::vector<double> slip;        ///< as measured
  Eigen::MatrixXd measured;        ///< rows x kChannels [-]
  Eigen::VectorXd slip_variance;   ///< variance of the true slip about the slip of `states`
  Eigen::VectorXd load_variance;   ///< relative variance of the true load about the load of `states`
  std::vector<int> run;  ///< run number of each row; each row without a run label has its own number
  /// Moment number of each row for a drive of a rover with several wheels and no measured drawbar pull DP;
  /// DP/W of the first row of a moment is then that of the whole rover, from the slope. Empty for other
  /// tables.
  std::vector<int> moment;
  std::vector<std::string> covariates;  ///< numeric columns that vary, without answers
  std::vector<std::string> groupings;   ///< text columns with few distinct values, without runs
  std::vector<std::string> dropped;     ///< columns removed by the screening: column_screening.hpp
  std::vector<std::string> chance;      ///< covariates kept by the screening without significance

  /// Number of rows.
  int rows() const { return static_cast<int>(states.size()); }
  bool has(Channel channel) const;  ///< returns true if any row measures the channel
  /// Denominator of the scaled channel: r for sinkage, r W for torque, otherwise W, with the measured load W.
  double denominator(int row, Channel channel) const;
};

/// Components of an error shared by rows of one unit (a run, a stretch of time): an offset of each channel
/// [-] and, because soils vary between places, the logarithms of soil strength (c, tan phi) and stiffness
/// (k).
inline constexpr int kShared = kChannels + 2;

/// One value per component.
using SharedVector = Eigen::Matrix<double, kShared, 1>;
using SharedFactor = Eigen::Matrix<double, kChannels, kShared>;  ///< effect of each component on a row
using SoilFactor = Eigen::Matrix<double, kChannels, kShared - kChannels>;  ///< columns of the soil components
using RunError = Eigen::Matrix<double, kShared, kShared>;                  ///< covariance of the components

/// Error shared by the rows of units.
struct SharedError {
  std::vector<int> unit{};            ///< of each row; empty: rows share no error
  RunError run = RunError::Zero();    ///< covariance of the components
  std::vector<SoilFactor> by_soil{};  ///< of each row; empty: the soil does not vary

  double variance(int channel) const;      ///< in one channel, mean over the rows [-]
  double soilVariance(int channel) const;  ///< contribution of the soil components to variance() [-]
};

/// A sensor whose error must be larger than stated if the model has no missing effect.
struct StrainedSensor {
  std::string column;                   ///< column of the sensor
  double declared = 0.0, fitted = 0.0;  ///< standard deviations [unit of the column]
};

/// Converts telemetry to a trial. Rows without wheel dimensions use the wheel of the model. Throws InputError
/// if no load, slip or answer is measured, or if a wheel is unknown.
Trial makeTrial(const Telemetry& telemetry, const RefinedModel& model);

/// State of each row of telemetry without answers: the input of predictions. Errors as makeTrial().
std::vector<WheelState> statesOf(const Telemetry& telemetry, const RefinedModel& model);

/// Returns true if slip was measured with the full travel speed instead of its component along the wheel
/// plane, according to speed_mps and rim_speed_mps of rows with a slip angle; false if undecided.
bool slipIsAlongTravel(const std::vector<WheelState>& states);

/// Marks rows with z >= r (wheel sunk to its axle or deeper), which would distort a fit: in all contact
/// models the contact of the rim ends at the height of the axle.
std::vector<char> beyondAxle(const Trial& trial);

/// Values of a covariate over the rows; "sinkage_m" is the sinkage of the model; NaN = missing.
Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m);

/// The rows of a trial marked by `keep`.
Trial subset(const Trial& trial, const std::vector<char>& keep);

/// Marks the rows for fits of the soil: wheels without slip angle (|angle| < 0.1 rad) if there are at least
/// 20 such rows, otherwise all rows.
std::vector<char> rowsOfSoil(const Trial& trial);

/// The trial with slip and load as measured, before calibration of the inputs.
Trial asMeasured(Trial trial);

/// Predictions of the model for all rows over the measured load, rows x kChannels [-]. With moments, DP/W of
/// the first row of a moment is the sum of the wheels' pulls over the sum of their loads. `solved` (may be
/// empty initially) caches solutions between calls.
Eigen::MatrixXd predictRows(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

}  // namespace talus::terramech
