#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

#include "made_rows.hpp"

namespace talus::terramech {

inline RefinedModel base() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

inline WheelState state(double slip = 0.5) {
  WheelState s;
  s.wheel.radius_m = 0.12;
  s.wheel.grouser_height_m = 0.01;
  s.load_N = 80.0;
  s.slip = slip;
  s.slip_angle_rad = 0.2;
  s.speed_mps = 0.1;
  s.rim_speed_mps = 0.2;
  s.time_s = 0.3;
  s.pass_index = 3.0;
  s.slope_rad = 0.15;
  return s;
}

inline Effect typical(const EffectForm& form) {
  Effect effect{.name = form.name, .covariate = form.covariate, .channel = form.channel};
  for (const EffectParameter& p : form.parameters) effect.parameters.push_back(p.typical);
  return effect;
}

inline double change(const Reading& a, const Reading& b) {
  double most = 0.0;
  for (int c = 0; c < kChannels; ++c)
    most = std::max(most, std::abs(a.scaled(static_cast<Channel>(c)) - b.scaled(static_cast<Channel>(c))));
  return most;
}

inline Effect with(const char* name, std::vector<double> parameters) {
  Effect effect = typical(*findEffect(name));
  effect.parameters = std::move(parameters);
  return effect;
}

inline WheelState straightOn(double slip) {
  WheelState s = state(slip);
  s.slip_angle_rad = 0.0;
  return s;
}

/// A contact with round numbers for tests of single forms.
inline WheelContact plainContact() {
  WheelContact c;
  c.load_N = 100.0;
  c.radius_m = c.shear_radius_m = 0.2;
  c.width_m = 0.1;
  c.sinkage_modulus = 1e6;
  c.sinkage_exponent = 1.0;
  c.cohesion_Pa = 1000.0;
  c.tan_friction = 0.5;
  c.shear_modulus_m = 0.02;
  return c;
}

/// plainContact() after a form has acted at a value of its covariate.
inline WheelContact acted(const char* name, std::vector<double> parameters, double x,
                          const WheelState& s = {}) {
  WheelContact c = plainContact();
  findEffect(name)->act({parameters.data(), s, x}, c);
  return c;
}

/// A reading after a form has changed it.
inline Reading readWith(const char* name, std::vector<double> parameters, double x, const WheelState& s,
                        const WheelContact& c, Reading reading) {
  findEffect(name)->read({parameters.data(), s, x}, c, reading);
  return reading;
}

}  // namespace talus::terramech
