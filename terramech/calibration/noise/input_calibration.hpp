#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/nominal_load.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Whether the measured slip varies by more than its own error may: by twice as much. Where it does not, what
/// its error does to the readings is itself a smooth function of the measured slip, and a smooth of it would
/// hide the error. `noise` is that of residuals without a smooth of slip; more than a tenth of the slip is
/// not taken for error.
bool slipIsSeen(const Trial& trial, const SensorNoise& noise);

/// Number of the set speed over ground of each row: one of the whole table where its speeds, had from slip and rim
/// speed, vary by no more than twice what the slips' error makes of them, else one of each run where those within
/// runs do. The mean speed tells each row's slip better than its own reading then: 1 - v / (r omega). Empty where
/// speeds vary by more, where the three columns are not tied, or where slips are not seen. `noise` as above.
std::vector<int> setSpeeds(const Trial& trial, const SensorNoise& noise);

/// Whether slips are seen to vary, and speeds beyond one of the whole table.
bool inputsAreSeen(const Trial& trial, const SensorNoise& noise);

/// Standard deviation of the error that all rows' slips share: that of the mean where there is one level of
/// slip, or of the mean speed where there is one speed; empty where rows err each by themselves.
Eigen::VectorXd sharedSlipStd(const Trial& trial, const SensorNoise& noise);

/// Sets a slip, and the speed over ground with it where the row's speeds agree with the slip it had: the
/// three were then had from two.
void setSlip(WheelState& state, double slip);

/// Replaces slip and load of the states by their posterior means given what was measured, and sets their
/// variances: the distribution of true values is found from all rows (nonparametric maximum likelihood,
/// kiefer_wolfowitz_1956), so that the attenuation by noisy inputs is taken out. Call it with the measured
/// slip and load in the states. Set loads, where they are known, take the place of that of loads.
void calibrateInputs(Trial& trial, const SensorNoise& noise, const std::optional<NominalLoad>& set = {});

}  // namespace talus::terramech
