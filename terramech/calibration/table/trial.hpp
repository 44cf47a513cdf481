#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Measured rows as residual tracing sees them. Channels of `measured` are those of Channel, scaled; NaN =
/// missing.
struct Trial {
  std::vector<WheelState> states;  ///< slip and load replaced by their best solved once inputs are calibrated
  std::vector<double> load_N;      ///< as measured: the denominator of every ratio
  std::vector<double> slip;        ///< as measured
  Eigen::MatrixXd measured;        ///< rows x kChannels [-]
  Eigen::VectorXd slip_variance;   ///< of the true slip about states' slip
  Eigen::VectorXd load_variance;   ///< of the true load about states' load, relative
  std::vector<int> run;  ///< number of the run of each row; a row of its own where there is no run column
  /// Number of the moment of each row where a rover drove with several wheels of unmeasured drawbar pull:
  /// DP/W of a moment's first row is then the whole rover's, as the slope requires. Empty otherwise.
  std::vector<int> moment;
  std::vector<std::string> covariates;  ///< numeric columns that vary, answers left out
  std::vector<std::string> groupings;   ///< text columns of few words, runs left out
  std::vector<std::string> dropped;     ///< columns that a screening left out of both: column_screening.hpp
  std::vector<std::string> chance;      ///< covariates that it kept, but by chance as it seems

  int rows() const { return static_cast<int>(states.size()); }
  bool has(Channel channel) const;  ///< whether any row measures it
  double denominator(int row, Channel channel) const;
};

/// Parts of an error that the rows of one unit (a run, a stretch of time) share: an offset of each channel [-] and,
/// since soils scatter from place to place, the logarithms of the soil's strength (c, tan phi) and stiffness (k).
inline constexpr int kShared = kChannels + 2;

using SharedVector = Eigen::Matrix<double, kShared, 1>;
using SharedFactor = Eigen::Matrix<double, kChannels, kShared>;  ///< what one unit of each part does to a row
using SoilFactor = Eigen::Matrix<double, kChannels, kShared - kChannels>;  ///< that of the soil's parts
using RunError = Eigen::Matrix<double, kShared, kShared>;                  ///< covariance of the parts

/// That error.
struct SharedError {
  std::vector<int> unit{};            ///< of each row; empty: rows are on their own
  RunError run = RunError::Zero();    ///< its covariance
  std::vector<SoilFactor> by_soil{};  ///< of each row; empty: the soil does not vary

  double variance(int channel) const;      ///< in one channel, mean over the rows [-]
  double soilVariance(int channel) const;  ///< the share of the soil's parts in it [-]
};

/// A sensor that errs more than is stated of it, if nothing else is to be missing.
struct StrainedSensor {
  std::string column;
  double declared = 0.0, fitted = 0.0;  ///< standard deviations, in the unit of the column
};

/// Rows of telemetry as a trial. `fallback` is the wheel of rows without wheel dimensions. Throws InputError
/// when no load, slip or answer is measured, or no wheel is known.
Trial makeTrial(const Telemetry& telemetry, const RefinedModel& model);

/// The state of each row of telemetry, answers left out: what predictions are made from. Errors as
/// makeTrial().
std::vector<WheelState> statesOf(const Telemetry& telemetry, const RefinedModel& model);

/// Whether slip was measured with the full speed of travel rather than its part along the wheel plane, told
/// from speed_mps and rim_speed_mps of rows with a slip angle; false when undecided.
bool slipIsAlongTravel(const std::vector<WheelState>& states);

/// Rows whose wheel is sunk to its axle or deeper, z >= r: the rim's contact ends at the axle's height in
/// every model here, so that they say nothing of it and would bend it elsewhere.
std::vector<char> beyondAxle(const Trial& trial);

/// Values of a covariate over the rows; "sinkage_m" is the model's, NaN where missing.
Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m);

/// The rows of a trial that `keep` marks.
Trial subset(const Trial& trial, const std::vector<char>& keep);

/// Rows of which a soil is learned: those of wheels that roll straight where there are 20 of them, else all. At an angle
/// the base has no say.
std::vector<char> rowsOfSoil(const Trial& trial);

/// The rows at slip and load as they were measured, whatever calibration made of them.
Trial asMeasured(Trial trial);

/// Model readings of all rows over the measured load, rows x kChannels [-]; with moments, DP/W of a moment's
/// first row is the sum of its wheels' pulls over the sum of their loads. `solved` (may be empty at first)
/// carries what was solved from call to call.
Eigen::MatrixXd predictRows(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

}  // namespace talus::terramech
