#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration.hpp>

namespace talus::terramech {

/// Returns true if the measured slip varies by more than twice its possible error. Otherwise the effect of
/// the slip error on the readings is a smooth function of the measured slip, and a smooth function of slip
/// that is removed from the residuals would hide the error. `noise` must be estimated from residuals from
/// which no smooth function of slip was removed; at most a tenth of the slip is treated as error.
bool slipIsSeen(const Trial& trial, const SensorNoise& noise);

/// Returns for each row the index of its set speed over ground, the constant speed of a group of rows. The
/// whole table has one set speed if the speeds that follow from slip and rim speed vary by at most twice the
/// effect of the slip error. Otherwise each run has one set speed if the speeds within runs vary by no more
/// than that. The mean speed v of the group then gives a more accurate slip than the reading: 1 - v / (r
/// omega). Returns an empty vector if speeds vary more, if slip, speed and rim speed are not consistent, or
/// if slipIsSeen() is false. `noise` has the meaning of the argument of slipIsSeen().
std::vector<int> setSpeeds(const Trial& trial, const SensorNoise& noise);

/// Returns true if slipIsSeen() is true and the rows do not all have one set speed.
bool inputsAreSeen(const Trial& trial, const SensorNoise& noise);

/// Returns the standard deviation of the slip error that all rows share: for a single slip level, that of the
/// mean slip; for a single set speed, that of the mean speed. Returns an empty vector if the rows have
/// independent slip errors.
Eigen::VectorXd sharedSlipStd(const Trial& trial, const SensorNoise& noise);

/// Sets the slip of a state. Two of slip, speed and rim speed determine the third; if the three were
/// consistent, the speed over ground is therefore updated as well.
void setSlip(WheelState& state, double slip);

/// Loads that the operator set, one for each run or a few levels.
struct SetLoads {
  std::vector<int> group;  ///< number of the run or level of each row
  Eigen::ArrayXd load_N;   ///< geometric mean of the readings of the row's group
  double scatter;          ///< standard deviation of ln(reading / load_N) [-]
};

/// Returns the set loads of a trial: a group has four rows on average, and its readings scatter by less than
/// 10 %. Returns nullopt without such groups, and for a rover's own drive.
std::optional<SetLoads> setLoads(const Trial& trial);

/// Replaces slip and load of each state by the posterior means of the true values given the measurements, and
/// sets their posterior variances. The distribution of true values is estimated from all rows (nonparametric
/// maximum likelihood, kiefer_wolfowitz_1956), which removes the attenuation of dependences by noisy inputs.
/// The states must contain the measured slip and load. Slips at set speeds are normal about the mean of
/// their group instead, and loads are those of `set`, if it is not empty.
void calibrateInputs(Trial& trial, const SensorNoise& noise, const std::optional<SetLoads>& set = {});

}  // namespace talus::terramech
