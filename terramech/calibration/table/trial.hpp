#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/effects/channel_reading.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/model_file.hpp>

/// Table of wheel telemetry together with the wheel model for its rows.
namespace talus::terramech {

/// Trial: the measured rows of a telemetry table, prepared for residual tracing (search for the effects that
/// a wheel model lacks). The answers are the measured channels.
struct Trial {
  /// State of each row; slip and load are measured values, or estimates of the true values after
  /// calibrateInputs().
  std::vector<WheelState> states;
  std::vector<double> load_N;  ///< measured load of each row; denominator of every ratio
  std::vector<double> slip;    ///< measured slip of each row
  Eigen::MatrixXd measured;  ///< scaled channels in the order of Channel, rows x kChannels [-]; NaN: missing
  Eigen::VectorXd slip_variance;  ///< variance of the true slip about the slip of `states`
  Eigen::VectorXd load_variance;  ///< relative variance of the true load about the load of `states`
  std::vector<int> run;  ///< run number of each row; a row without a run label has a number of its own
  /// Moment number of each row of a rover's own drive: telemetry of several wheels without a measured drawbar
  /// pull DP. The rows of all wheels of a run at one time form a moment. DP/W of the first row of a moment is
  /// that of the whole rover, computed from the slope. Empty for other tables.
  std::vector<int> moment;
  /// Numeric columns that vary, without the answers and without columns that are linear functions of an
  /// answer.
  std::vector<std::string> covariates;
  std::vector<std::string> groupings;  ///< text columns with few distinct values, without the run column
  std::vector<std::string> dropped;    ///< columns that the screening removed (column_screening.hpp)
  std::vector<std::string> chance;     ///< covariates that the screening kept without significance

  /// Returns the number of rows.
  int rows() const { return static_cast<int>(states.size()); }
  bool has(Channel channel) const;  ///< returns true if any row measures the channel
  /// Returns the denominator of a scaled channel: r for sinkage, r W for torque, otherwise W, with the
  /// measured load W.
  double denominator(int row, Channel channel) const;
};

/// Number of components of an error that the rows of a unit (a run, a stretch of time) share. The components
/// are an offset of each channel [-] and, because soils vary between locations, the logarithms of soil
/// strength (c, tan phi) and of stiffness (k).
inline constexpr int kShared = kChannels + 2;

/// Value of each component of the shared error.
using SharedVector = Eigen::Matrix<double, kShared, 1>;
/// Effect of each component on the channels of a row.
using SharedFactor = Eigen::Matrix<double, kChannels, kShared>;
/// Effect of the soil components on the channels of a row.
using SoilFactor = Eigen::Matrix<double, kChannels, kShared - kChannels>;
using RunError = Eigen::Matrix<double, kShared, kShared>;  ///< covariance of the components

/// Error that the rows of a unit share.
struct SharedError {
  std::vector<int> unit{};          ///< unit number of each row; empty: rows share no error
  RunError run = RunError::Zero();  ///< covariance of the components
  /// Effect of the soil components on each row; empty: the soil does not vary.
  std::vector<SoilFactor> by_soil{};

  double variance(int channel) const;      ///< variance in one channel, mean over the rows [-]
  double soilVariance(int channel) const;  ///< part of variance() that the soil components cause [-]
};

/// Sensor whose error must be larger than stated if the model lacks no effect.
struct StrainedSensor {
  std::string column;                   ///< column of the sensor
  double declared = 0.0, fitted = 0.0;  ///< stated and fitted standard deviation, in the unit of the column
};

/// Converts telemetry to a trial. Rows without wheel dimensions use the wheel of the model. Throws InputError
/// if no load, slip or answer is measured, or if the dimensions of a wheel are unknown.
Trial makeTrial(const Telemetry& telemetry, const RefinedModel& model);

/// Returns the state of each row of telemetry without answers, as input of predictions. Throws the exceptions
/// of makeTrial().
std::vector<WheelState> statesOf(const Telemetry& telemetry, const RefinedModel& model);

/// Returns true if slip was measured with the full travel speed in place of its component along the wheel
/// plane. The columns speed_mps and rim_speed_mps of rows with a slip angle decide; the result is false if
/// these columns do not suffice.
bool slipIsAlongTravel(const std::vector<WheelState>& states);

/// Marks rows with sinkage z >= wheel radius r (wheel sunk to its axle or deeper). Such rows would distort a
/// fit, because in all contact models the contact of the rim ends at the height of the axle.
std::vector<char> beyondAxle(const Trial& trial);

/// Returns the values of a covariate over the rows; NaN: missing. For the name "sinkage_m" these are the
/// model's sinkages.
Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m);

/// Returns the rows of a trial marked by `keep`.
Trial subset(const Trial& trial, const std::vector<char>& keep);

/// Marks the rows for fits of the soil. These are the rows without slip angle (|angle| < 0.1 rad) if the
/// trial has at least 20 such rows, otherwise all rows.
std::vector<char> rowsOfSoil(const Trial& trial);

/// Returns the trial with slip and load as measured.
Trial asMeasured(Trial trial);

/// Returns the predicted scaled channels of a model for all rows, over the measured load, rows x kChannels
/// [-]. If the trial has moments, DP/W of the first row of a moment is the sum of the wheels' pulls over the
/// sum of their loads. `solved` caches contact solutions between calls and may be empty initially.
Eigen::MatrixXd predictRows(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Telemetry columns of the quantities that a wheel model predicts (answers), in the order of Channel.
inline constexpr std::array<const char*, kChannels> kAnswers{"drawbar_pull_N", "sinkage_m", "torque_Nm",
                                                             "side_force_N"};

/// Returns true if a column is one of kAnswers.
inline bool isAnswer(std::string_view column) {
  return std::find(kAnswers.begin(), kAnswers.end(), column) != kAnswers.end();
}

/// Reads the model from a soil or model file and sets its wheel to that of a rover (library name or file).
/// With an empty `file` the model is unknownSoil(); with an empty `rover` the wheel of the model is kept.
/// Throws the exceptions of loadModel() and loadRover().
ModelFile baseModel(const std::string& file, const std::string& rover);

/// Wheel model, and the rows of a table to which the model applies.
struct ModelRows {
  RefinedModel model;  ///< the given model, with slip_along_travel set if slipIsAlongTravel() of the rows
  Trial trial;         ///< rows to which the model applies
  Trial beyond_axle;   ///< rows with sinkage z >= wheel radius r (beyondAxle())
  /// Rejected rows of the table, including rows with a side force but no slip angle.
  std::vector<RejectedRow> rejected;
};

/// Selects the rows of a table for a model. Throws the exceptions of leaveOutWithoutSlipAngle() and
/// makeTrial().
ModelRows modelRows(Telemetry table, const RefinedModel& model);

}  // namespace talus::terramech
