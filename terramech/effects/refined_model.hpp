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

/// Standard deviations of what the sensors read: absolute + relative parts add in squares.
struct SensorNoise {
  std::array<double, kChannels> absolute{};  ///< of DP [N], z [m], T [N m], F [N]
  std::array<double, kChannels> relative{};  ///< of the value read [-]
  double slip_absolute = 0.0;                ///< [-]
  double slip_relative = 0.0;                ///< of the slip
  double load_relative = 0.0;                ///< of the load

  /// Standard deviation of a measured slip in [-1, 1] [-]. The relative part ends at the locked wheel, i = -1: r omega = 0
  /// is read without error.
  double slipStd(double slip) const;
};

/// Standard deviations as a base file states them, in the unit of the column; empty where it states none.
struct StatedSensors {
  std::optional<double> load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N;
};

/// A number of a model that was fitted, and how well it is known.
struct FittedParameter {
  int effect = -1;  ///< index into effects; -1: of the soil
  int index = 0;    ///< of the effect's parameters, or of soilParameters()
};

/// How the drawbar pull follows from the solved contact.
enum class BaseModel {
  WongReece,     ///< integral of the stresses
  LinearFormula  ///< DP/W = T/(rW) - z/r - 0.1 (kang_2003, Eq. 3.21) of the measured torque and sinkage; of
                 ///< the solved ones where a state has none
};

/// Wong-Reece and the effects that data have shown: what estimate, assess, costmap, plan and drive take as a
/// model. Plain data; a model without effects is the base model.
struct RefinedModel {
  BaseModel base = BaseModel::WongReece;
  Soil soil;
  std::map<std::string, double> soil_prior_mean;  ///< by field name, of those below
  std::map<std::string, double> soil_prior_std;   ///< by field name; fields that are not in it are exact
  std::vector<Effect> effects;                    ///< act in this order
  bool slip_along_travel =
      false;                   ///< slip was measured with the full speed, not its part along the wheel plane
  std::optional<Wheel> wheel;  ///< for rows that do not say which wheel they are of
  double gravity_m_s2 = 9.80665;  ///< where those rows were measured
  StatedSensors stated;
  SensorNoise noise;                    ///< for standard deviations of predictions
  std::vector<FittedParameter> fitted;  ///< order of covariance
  std::vector<double> covariance;       ///< row-major, of fitted, in their own units; empty: not known

  /// Rows that do not say otherwise are of this rover's wheel, in the gravity where it drives.
  void takeRover(const Rover& rover) {
    wheel = rover.wheel;
    gravity_m_s2 = rover.gravity_m_s2;
  }
};

/// The readings of the sensors that the model predicts. Never throws on a state that validate()s;
/// `entry_guess_rad`, where given, starts the search for the sinkage and receives its result. Thread-safe.
Reading predict(const RefinedModel& model, const WheelState& state, double* entry_guess_rad = nullptr);

/// The same for many states, several times faster where no effect leaves the plain wheel, and where `solved`
/// holds a state's contact already: nothing is solved again for what only the readings show.
std::vector<Reading> predict(const RefinedModel& model, std::span<const WheelState> states,
                             SolvedContacts& solved);

/// A prediction and the standard deviation of what would be measured: parameters, slip, load and the sensor
/// itself.
struct Prediction {
  Reading mean;
  std::array<double, kChannels> scaled_std{};  ///< of DP/W, z/r, T/(rW), F/W
};
Prediction predictWithStd(const RefinedModel& model, const WheelState& state);

/// The model without what its sensors err: what the ground does.
RefinedModel withoutSensors(RefinedModel model);

/// Fields of a soil that a fit may move.
struct SoilParameter {
  const char* name;
  double low, high, scale;  ///< bounds and a typical step, in its own unit
  double (*get)(const Soil&);
  void (*set)(Soil&, double);
};
const std::vector<SoilParameter>& soilParameters();

/// Value of a fitted number, and changing it.
double value(const RefinedModel& model, const FittedParameter& parameter);
void setValue(RefinedModel& model, const FittedParameter& parameter, double value);

/// Slip along the wheel plane from slip along the travel at slip angle beta: both with travelRatio(), whose
/// travel per rolled arc shrinks by cos beta.
double slipInWheelPlane(double slip_along_travel, double slip_angle_rad);

}  // namespace talus::terramech
