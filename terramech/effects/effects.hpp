#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/effects/channel_reading.hpp>
#include <talus/terramech/effects/wheel_contact.hpp>
#include <talus/terramech/effects/wheel_state.hpp>

/// Effects that the Wong-Reece model lacks, as corrections that can be combined. An effect changes the
/// wheel-soil contact before the equilibrium is solved, or the sensor readings afterwards. The effect library
/// lists formula, parameters with bounds, source and signature of each known effect (its form). The covariate
/// of an effect is the quantity on which the effect depends: a column of telemetry.
namespace talus::terramech {

/// Parameter of an effect form.
struct EffectParameter {
  /// Name in model files.
  const char* name;
  const char* unit;    ///< unit; "-" if dimensionless
  double low, high;    ///< physical bounds, which also limit a fit
  double typical;      ///< initial value of a fit, and value at which a candidate effect is tested
  bool fitted = true;  ///< false: computed from the data (a first pass, a start time) and not fitted
};

/// Arguments with which an effect is evaluated for one wheel state.
struct EffectInput {
  const double* parameter;  ///< parameter values in the order of EffectForm::parameters
  const WheelState& state;  ///< operating state of the wheel
  double x;                 ///< value of the covariate, finite
};

/// Form of an effect: an entry of the effect library. Plain data with static lifetime.
struct EffectForm {
  const char* name;
  const char* family;     ///< name shared by all forms of one physical cause
  const char* covariate;  ///< telemetry column with which the residual correlates
  Channel channel;        ///< channel with the largest residual
  const char* formula;
  const char* source;     ///< keys of REFERENCES.bib, or "ours"
  const char* signature;  ///< description of the residual by which the effect is recognised
  std::vector<EffectParameter> parameters;
  /// Function that changes the contact before the contact is solved; null: no change.
  void (*act)(const EffectInput&, WheelContact&) = nullptr;
  /// Function that changes the readings after the contact is solved; null: no change.
  void (*read)(const EffectInput&, const WheelContact&, Reading&) = nullptr;
  bool of_sensor = false;  ///< true: sensor error, which does not influence the ground or routes
};

/// Returns the library of all effect forms.
const std::vector<EffectForm>& effectLibrary();

/// Returns the library entry with this name, or nullptr. Accepts the prefixes "moisture_" and "temperature_"
/// that model files of version 0.1 contain.
const EffectForm* findEffect(std::string_view name);

/// Effect of a model: a library form with parameter values, or a curve fitted to a measured residual. A curve
/// has a name that begins with "empirical". The curve is a natural cubic spline through (knots, parameters)
/// over the covariate, constant beyond the outermost knots. The curve "empirical" is added to one scaled
/// channel. In the channel F/W (side force over load) the curve is multiplied by sin beta, where beta is the
/// slip angle, because the side force is odd in beta.
struct Effect {
  std::string name{};                      ///< name of a library form, or "empirical..." for a curve
  std::string covariate{};                 ///< telemetry column on which the effect depends
  Channel channel = Channel::DrawbarPull;  ///< channel to which a curve is added
  std::vector<double> parameters{};  ///< library form: its parameters; curve: its values at the knots [-]
  /// Ascending values in the unit of the covariate. A curve has one knot per parameter; a library form has no
  /// knots, or 2 limits to which the covariate is clamped.
  std::vector<double> knots{};
  std::string only_column{};  ///< text column that restricts the effect to one group of rows
  std::string only_value{};   ///< text of this group in `only_column`; empty: all rows

  /// Returns true if the effect is a curve. The exponential of the curve "empirical_stiffness" multiplies the
  /// sinkage modulus k; that of a curve with any other suffix multiplies cohesion c and tan phi.
  bool empirical() const { return name.starts_with("empirical"); }

  /// Returns the factor on a curve at this slip angle: sin(slip_angle_rad) for the channel F/W, otherwise 1.
  double sense(double slip_angle_rad) const;
};

/// Returns true if any effect has the covariate pass_index, the number of wheel passes over a track.
bool knowsPasses(std::span<const Effect> effects);

namespace detail {
/// Return the library entries of one kind: contact, digging, forces, sensors, drifts.
std::vector<EffectForm> contactEffects();
std::vector<EffectForm> diggingEffects();
std::vector<EffectForm> forceEffects();
std::vector<EffectForm> sensorEffects();
std::vector<EffectForm> driftEffects();
}  // namespace detail

}  // namespace talus::terramech
