#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/noise/nominal_load.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Returns true if the measured slip varies by more than twice its possible error. Otherwise the effect of
/// the slip error on the readings is a smooth function of the measured slip, and a smooth of slip would hide
/// the error. `noise` is estimated from residuals without a smooth of slip; at most a tenth of the slip is
/// treated as error.
bool slipIsSeen(const Trial& trial, const SensorNoise& noise);

/// Returns the index of the set speed over ground of each row. The whole table has one speed if the speeds,
/// computed from slip and rim speed, vary by at most twice the effect of the slip error. Otherwise each run
/// has one speed if the speeds within runs vary by no more than that. The mean speed v then gives a more
/// accurate slip than the reading: 1 - v / (r omega). Empty if speeds vary more, if slip, speed and rim speed
/// are not consistent, or if slipIsSeen() is false. `noise` as in slipIsSeen().
std::vector<int> setSpeeds(const Trial& trial, const SensorNoise& noise);

/// Returns true if slips vary measurably and the table has more than one set speed.
bool inputsAreSeen(const Trial& trial, const SensorNoise& noise);

/// Standard deviation of the slip error shared by all rows: that of the mean for a single slip level, or of
/// the mean speed for a single speed; empty if the rows have independent errors.
Eigen::VectorXd sharedSlipStd(const Trial& trial, const SensorNoise& noise);

/// Sets the slip. Also updates the speed over ground if the row's speeds were consistent with the previous
/// slip: two of slip, speed and rim speed determine the third.
void setSlip(WheelState& state, double slip);

/// Replaces slip and load of the states by the posterior means given the measurements, and sets the posterior
/// variances. The distribution of true values is estimated from all rows (nonparametric maximum likelihood,
/// kiefer_wolfowitz_1956), which removes the attenuation by noisy inputs. The states must contain the
/// measured slip and load. Set loads, if known, replace the estimated distribution of loads.
void calibrateInputs(Trial& trial, const SensorNoise& noise, const std::optional<NominalLoad>& set = {});

}  // namespace talus::terramech
