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

/// Standard deviations of the sensor readings; absolute and relative components add in squares.
struct SensorNoise {
  std::array<double, kChannels> absolute{};  ///< of DP [N], z [m], T [N m], F [N]
  std::array<double, kChannels> relative{};  ///< relative to the reading [-]
  double slip_absolute = 0.0;                ///< [-]
  double slip_relative = 0.0;                ///< relative to the slip [-]
  double load_relative = 0.0;                ///< relative to the load [-]

  /// Standard deviation of a measured slip i in [-1, 1] [-]: absolute component and min(slip_relative |i|, 1
  /// + i), added in squares. The relative component is 0 for a locked wheel, whose r omega = 0 is measured
  /// exactly.
  double slipStd(double slip) const;
};

/// Standard deviations given in a model's base file, in the unit of the column; empty if not given.
struct StatedSensors {
  std::optional<double> load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N;
};

/// Index of a fitted parameter of a model.
struct FittedParameter {
  int effect = -1;  ///< index into effects; -1: parameter of the soil
  int index = 0;    ///< index into the parameters of the effect, or into soilParameters()
};

/// Computation of the drawbar pull from the solved contact.
enum class BaseModel {
  WongReece,  ///< integral of the stresses along the rim
  /// DP/W = T/(rW) - z/r - 0.1 (kang_2003, Eq. 3.21) with measured torque and sinkage, or solved ones if not
  /// measured
  LinearFormula
};

/// Wong-Reece model of a wheel with the effects found in data. The commands estimate, assess, costmap, plan
/// and drive accept this model. Plain data; without effects the model is the base model.
struct RefinedModel {
  BaseModel base = BaseModel::WongReece;
  Soil soil;
  /// Prior means of soilParameters() by field name.
  std::map<std::string, double> soil_prior_mean;
  /// Prior standard deviations by field name; a field without an entry is exactly known.
  std::map<std::string, double> soil_prior_std;
  std::vector<Effect> effects;  ///< applied in this order
  bool slip_along_travel =
      false;  ///< true: slip was measured with the full speed instead of its component along the wheel plane
  std::optional<Wheel> wheel;     ///< default for rows without wheel dimensions
  double gravity_m_s2 = 9.80665;  ///< default for rows without gravity
  StatedSensors stated;
  SensorNoise noise;                    ///< sensor errors, for standard deviations of predictions
  std::vector<FittedParameter> fitted;  ///< in the order of covariance
  std::vector<double> covariance;       ///< row-major, of `fitted`, in the parameters' units; empty: unknown

  /// Sets the default wheel and gravity to those of the rover.
  void takeRover(const Rover& rover) {
    wheel = rover.wheel;
    gravity_m_s2 = rover.gravity_m_s2;
  }
};

/// Returns the predicted sensor readings. Never throws for a valid state. If given, `entry_guess_rad` is the
/// initial value of the sinkage search and receives its result. Thread-safe.
Reading predict(const RefinedModel& model, const WheelState& state, double* entry_guess_rad = nullptr);

/// Returns the predicted sensor readings of many states. The computation is several times faster than single
/// calls if no effect changes the plain wheel, or if `solved` already contains the contact of a state:
/// effects on readings alone need no new solution.
std::vector<Reading> predict(const RefinedModel& model, std::span<const WheelState> states,
                             SolvedContacts& solved);

/// Prediction and standard deviation of a measurement, including the uncertainty of parameters, slip, load
/// and sensor.
struct Prediction {
  Reading mean;
  std::array<double, kChannels> scaled_std{};  ///< of DP/W, z/r, T/(rW), F/W
};
/// Returns the prediction with its standard deviation, by linear propagation of all errors. Never throws for
/// a valid state.
Prediction predictWithStd(const RefinedModel& model, const WheelState& state);

/// Returns the model without effects that are sensor errors. `fitted` and `covariance` are cleared.
RefinedModel withoutSensors(RefinedModel model);

/// Soil parameter that a fit may change.
struct SoilParameter {
  const char* name;
  double low, high, scale;     ///< bounds and typical step, in the unit of the parameter
  double (*get)(const Soil&);  ///< returns the value in a soil; 0 for log_stiffness
  void (*set)(Soil&, double);  ///< sets the value; log_stiffness v multiplies k_c and k_phi by e^v
};
/// Returns all soil parameters that a fit may change.
const std::vector<SoilParameter>& soilParameters();

/// Returns or sets the value of a fitted parameter.
double value(const RefinedModel& model, const FittedParameter& parameter);
void setValue(RefinedModel& model, const FittedParameter& parameter, double value);

/// Returns the slip along the wheel plane for a slip along the travel direction at slip angle beta. The ratio
/// v/(r omega) of travelRatio() is multiplied by cos beta.
double slipInWheelPlane(double slip_along_travel, double slip_angle_rad);

}  // namespace talus::terramech
