#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/terramech/effects/channel_reading.hpp>
#include <talus/terramech/effects/wheel_contact.hpp>
#include <talus/terramech/effects/wheel_state.hpp>

/// Effects that the Wong-Reece wheel lacks, as parts that compose: each changes the contact before it is
/// solved or what is read afterwards, and each has bounds, formula, source and signature.
namespace talus::terramech {

/// A number of an effect.
struct EffectParameter {
  const char* name;
  const char* unit;    ///< "-" for none
  double low, high;    ///< physical bounds, where a fit stays
  double typical;      ///< where a fit starts, and the size by which an effect is tried
  bool fitted = true;  ///< false: set from the data's design (a first pass, a start of time), never fitted
};

/// What one effect sees when it acts.
struct EffectInput {
  const double* parameter;
  const WheelState& state;
  double x;  ///< its covariate's value, finite
};

/// An entry of the library. Plain data with static lifetime.
struct EffectForm {
  const char* name;
  const char* family;     ///< forms of one cause share it
  const char* covariate;  ///< column that carries its signature
  Channel channel;        ///< where it shows most
  const char* formula;
  const char* source;     ///< keys of REFERENCES.bib, or "ours"
  const char* signature;  ///< what a residual looks like
  std::vector<EffectParameter> parameters;
  void (*act)(const EffectInput&, WheelContact&) = nullptr;
  void (*read)(const EffectInput&, const WheelContact&, Reading&) = nullptr;
  bool of_sensor = false;  ///< what the sensors err, not what the ground does: no route depends on it
};

/// The library.
const std::vector<EffectForm>& effectLibrary();

/// The entry of that name, or nullptr.
const EffectForm* findEffect(std::string_view name);

/// A form at work in a model, or, with form name "empirical", a curve of a measured residual: a natural cubic
/// spline through (knots, parameters) added to one scaled channel, constant beyond its ends; to F/W times sin beta, since
/// a wheel and its mirror image are pushed to opposite sides and one that rolls straight to none.
struct Effect {
  std::string name{};
  std::string covariate{};
  Channel channel = Channel::DrawbarPull;
  std::vector<double> parameters{};  ///< as in the form; of an empirical curve the values at its knots [-]
  std::vector<double> knots{};  ///< ascending [covariate]; of a known form none or the 2 ends it acts between
  std::string only_column{};    ///< acts only where this grouping column ...
  std::string only_value{};     ///< ... has this text; empty: everywhere

  /// Whether it is a curve: "empirical" adds to one scaled channel; "empirical_stiffness" and
  /// "empirical_strength" multiply k, or c and tan phi, by the exponential of the curve, and so move every
  /// channel.
  bool empirical() const { return name.starts_with("empirical"); }

  /// What a curve in one channel is multiplied by at this slip angle: sin beta in F/W, otherwise 1.
  double sense(double slip_angle_rad) const;
};

/// Whether one of them depends on how often a track was driven (pass_index).
bool knowsPasses(std::span<const Effect> effects);

namespace detail {
std::vector<EffectForm> contactEffects();
std::vector<EffectForm> diggingEffects();
std::vector<EffectForm> forceEffects();
std::vector<EffectForm> sensorEffects();
std::vector<EffectForm> driftEffects();
}  // namespace detail

}  // namespace talus::terramech
