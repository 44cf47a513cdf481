#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>
#include <talus/terramech/effects/wheel_state.hpp>

namespace talus::terramech {

/// Standard deviations of the sensor readings of a wheel. The absolute and the relative component add in
/// squares.
struct SensorNoise {
  std::array<double, kChannels> absolute{};  ///< absolute component, of DP [N], z [m], T [N m], F [N]
  std::array<double, kChannels> relative{};  ///< relative component, over the reading [-]
  double slip_absolute = 0.0;                ///< absolute component of the slip error [-]
  double slip_relative = 0.0;                ///< relative component of the slip error, over the slip [-]
  double load_relative = 0.0;                ///< load error over the load [-]

  /// Returns the standard deviation of a measured slip i in [-1, 1] [-]: the root sum of squares of
  /// slip_absolute and min(slip_relative |i|, 1 + i). The second component is 0 for a locked wheel, because
  /// its rim speed r omega = 0 is measured exactly.
  double slipStd(double slip) const;
};

/// Standard deviations of sensors that a model file states, in the unit of the column; empty if not stated.
struct StatedSensors {
  std::optional<double> load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N;
};

/// Identifies a parameter of a model that was fitted to data.
struct FittedParameter {
  int effect = -1;  ///< index into RefinedModel::effects; -1: the parameter belongs to the soil
  int index = 0;    ///< index into the parameters of this effect, or into soilParameters()
};

/// Formula by which a model computes the drawbar pull.
enum class BaseModel {
  WongReece,  ///< integral of the stresses along the rim (Wong and Reece)
  /// DP/W = T/(rW) - z/r - 0.1 (kang_2003, Eq. 3.21), with the measured torque T and sinkage z, or with the
  /// solved values if T and z are not measured.
  LinearFormula
};

/// Refined model: the Wong-Reece model of a wheel (the base model), with the effects that were found in data.
/// The commands estimate, assess, costmap, plan and drive accept this model. Plain data.
struct RefinedModel {
  /// Formula for the drawbar pull.
  BaseModel base = BaseModel::WongReece;
  Soil soil;
  /// Prior means of soil parameters, by name in soilParameters().
  std::map<std::string, double> soil_prior_mean;
  /// Prior standard deviations of soil parameters, by the same names; a parameter without an entry is exactly
  /// known.
  std::map<std::string, double> soil_prior_std;
  std::vector<Effect> effects;  ///< applied in this order
  /// True: slip was measured with the full travel speed in place of its component along the wheel plane.
  bool slip_along_travel = false;
  std::optional<Wheel> wheel;           ///< wheel of telemetry rows without wheel dimensions
  double gravity_m_s2 = 9.80665;        ///< gravity of telemetry rows without gravity
  StatedSensors stated;                 ///< sensor errors stated in the model file
  SensorNoise noise;                    ///< sensor errors used for the standard deviations of predictions
  std::vector<FittedParameter> fitted;  ///< fitted parameters, in the order of `covariance`
  /// Covariance of `fitted`, row-major, in the units of the parameters; empty: unknown.
  std::vector<double> covariance;

  /// Sets `wheel` and `gravity_m_s2` to the values of a rover.
  void takeRover(const Rover& rover) {
    wheel = rover.wheel;
    gravity_m_s2 = rover.gravity_m_s2;
  }
};

/// Returns the sensor readings that a model predicts for a wheel state. A non-null `entry_guess_rad` contains
/// the initial entry angle of the sinkage search and receives the resulting angle. Never throws for a valid
/// state. Thread-safe.
Reading predict(const RefinedModel& model, const WheelState& state, double* entry_guess_rad = nullptr);

/// Returns the predicted sensor readings of many wheel states. The computation is several times faster than
/// single calls if no effect changes the contact. The computation is also faster if `solved` already contains
/// the contact of a state, because effects that change only the readings need no new solution.
std::vector<Reading> predict(const RefinedModel& model, std::span<const WheelState> states,
                             SolvedContacts& solved);

/// Prediction of the sensor readings, with standard deviations that include the uncertainty of parameters,
/// slip, load and sensors.
struct Prediction {
  Reading mean;
  std::array<double, kChannels> scaled_std{};  ///< standard deviation of DP/W, z/r, T/(rW), F/W
};
/// Returns the prediction for a wheel state with its standard deviations, by linear propagation of all
/// errors. Never throws for a valid state.
Prediction predictWithStd(const RefinedModel& model, const WheelState& state);

/// Returns the model without the effects that are sensor errors. The result has empty `fitted` and
/// `covariance`.
RefinedModel withoutSensors(RefinedModel model);

/// Soil parameter that a fit may change, with access to its value in a Soil.
struct SoilParameter {
  const char* name;
  double low, high, scale;     ///< bounds and typical step of a fit, in the unit of the parameter
  double (*get)(const Soil&);  ///< returns the value in a soil; 0 for log_stiffness
  void (*set)(Soil&, double);  ///< sets the value in a soil; log_stiffness v multiplies k_c and k_phi by e^v
};
/// Returns all soil parameters that a fit may change.
const std::vector<SoilParameter>& soilParameters();

/// Return or set the value of a fitted parameter of a model.
double value(const RefinedModel& model, const FittedParameter& parameter);
void setValue(RefinedModel& model, const FittedParameter& parameter, double value);

/// Returns the slip along the wheel plane for a slip that was measured along the travel direction at the slip
/// angle beta. The conversion multiplies the ratio v/(r omega) of travelRatio() by cos beta.
double slipInWheelPlane(double slip_along_travel, double slip_angle_rad);

}  // namespace talus::terramech
