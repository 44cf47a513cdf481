#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/effects/channel_reading.hpp>
#include <talus/terramech/effects/wheel_contact.hpp>
#include <talus/terramech/effects/wheel_state.hpp>

/// Effects missing in the Wong-Reece model, as composable corrections. An effect changes the contact before
/// the equilibrium is solved, or the readings afterwards. The library states bounds, formula, source and
/// signature of each effect.
namespace talus::terramech {

/// Parameter of an effect.
struct EffectParameter {
  const char* name;
  const char* unit;    ///< "-" if dimensionless
  double low, high;    ///< physical bounds, which also limit a fit
  double typical;      ///< initial value of a fit; also the size at which a candidate is tested
  bool fitted = true;  ///< false: computed from the data (a first pass, a start time) and not fitted
};

/// Arguments of an effect.
struct EffectInput {
  const double* parameter;  ///< parameter values in the order of the form
  const WheelState& state;  ///< operating state of the wheel
  double x;                 ///< value of the covariate, finite
};

/// Entry of the effect library. Plain data with static lifetime.
struct EffectForm {
  const char* name;
  const char* family;     ///< common to all forms of one cause
  const char* covariate;  ///< column with which the residual correlates
  Channel channel;        ///< channel with the largest residual
  const char* formula;
  const char* source;     ///< keys of REFERENCES.bib, or "ours"
  const char* signature;  ///< description of the residual that indicates the effect
  std::vector<EffectParameter> parameters;
  /// Changes the contact before it is solved; null: no change.
  void (*act)(const EffectInput&, WheelContact&) = nullptr;
  /// Changes the readings after the contact is solved; null: no change.
  void (*read)(const EffectInput&, const WheelContact&, Reading&) = nullptr;
  bool of_sensor = false;  ///< true: sensor error, without influence on the ground or on routes
};

/// Returns the library of all effect forms.
const std::vector<EffectForm>& effectLibrary();

/// Returns the entry with this name, or nullptr. Accepts the prefixes "moisture_" and "temperature_" of model
/// files of version 0.1.
const EffectForm* findEffect(std::string_view name);

/// Effect of a model: a library form with parameters, or a curve of a measured residual. The curve (name
/// "empirical") is a natural cubic spline through (knots, parameters), added to one scaled channel and
/// constant beyond its ends. In the channel F/W (side force over load) the curve is multiplied by sin beta,
/// beta the slip angle: the side force is odd in beta.
struct Effect {
  std::string name{};       ///< name of a library form, or "empirical..." for a curve
  std::string covariate{};  ///< column on which the effect depends
  Channel channel = Channel::DrawbarPull;
  std::vector<double> parameters{};  ///< library form: its parameters; curve: values at the knots [-]
  /// Ascending [covariate]; library form: none, or the 2 limits to which the covariate is clamped.
  std::vector<double> knots{};
  std::string only_column{};  ///< text column that restricts the effect to one group
  std::string only_value{};   ///< text of that group in `only_column`; empty: all rows

  /// Returns true if the effect is a curve. The curve "empirical" is added to one scaled channel. The
  /// exponential of the curve "empirical_stiffness" multiplies the sinkage modulus k, that of any other curve
  /// cohesion c and tan phi.
  bool empirical() const { return name.starts_with("empirical"); }

  /// Returns the factor on a curve in one channel at this slip angle: sin beta for F/W, otherwise 1.
  double sense(double slip_angle_rad) const;
};

/// Returns true if any effect has the covariate pass_index, the number of passes over a track.
bool knowsPasses(std::span<const Effect> effects);

namespace detail {
/// Parts of the library by kind: contact, digging, forces, sensors, drifts.
std::vector<EffectForm> contactEffects();
std::vector<EffectForm> diggingEffects();
std::vector<EffectForm> forceEffects();
std::vector<EffectForm> sensorEffects();
std::vector<EffectForm> driftEffects();
}  // namespace detail

}  // namespace talus::terramech
