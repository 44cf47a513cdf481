#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/shear_displacement.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/natural_spline.hpp>
#include <talus/terramech/numerics/squared.hpp>

namespace talus::terramech {
namespace {

/// Effects of a model with their forms looked up.
class Bound {
 public:
  explicit Bound(const RefinedModel& model) : model_(model) {
    for (const Effect& e : model.effects)
      effects_.push_back({&e, e.empirical() ? nullptr : findEffect(e.name),
                          e.empirical() ? NaturalSpline(e.knots, e.parameters) : NaturalSpline()});
  }

  WheelContact contact(const WheelState& state) const;
  Reading reading(const WheelState& state, const WheelContact& contact, const ContactForces& forces) const;

 private:
  struct BoundEffect {
    const Effect* effect;
    const EffectForm* form;  ///< null for a curve
    NaturalSpline curve;
  };

  static bool applies(const Effect& effect, const WheelState& state) {
    return effect.only_column.empty() || state.label(effect.only_column) == effect.only_value;
  }

  /// Returns the covariate of an effect. For sinkage_m the covariate is the sinkage of the model, not the
  /// measured sinkage.
  static double covariateOf(const Effect& effect, const WheelState& state, double sinkage_m) {
    return effect.covariate == "sinkage_m" ? sinkage_m : state.covariate(effect.covariate);
  }

  /// Returns the state with the effect's covariate clamped to the effect's range.
  static WheelState atEdge(const BoundEffect& e, WheelState state) {
    const auto& ends = e.effect->knots;
    const std::string& column = e.effect->covariate;
    state.setCovariate(column, std::clamp(state.covariate(column), ends.front(), ends.back()));
    return state;
  }

  static bool beyond(const BoundEffect& e, double x) {
    return e.effect->knots.size() == 2 && (x < e.effect->knots.front() || x > e.effect->knots.back());
  }

  static void bend(const BoundEffect& curve, double x, WheelContact& contact);

  const RefinedModel& model_;
  std::vector<BoundEffect> effects_;
};

double cosineOf(double slip_angle_rad) {
  return std::cos(std::min(std::abs(slip_angle_rad), kSteepestSlipAngle_rad));
}

/// r omega / v with the full speed v; at most 1e3, for a wheel that spins in place.
double rolling(const WheelState& state, bool slip_along_travel) {
  const double share = slip_along_travel ? 1.0 : cosineOf(state.slip_angle_rad);
  return std::min(share / std::max(travelRatio(std::clamp(state.slip, -1.0, 1.0)), 1e-9), 1e3);
}

/// Applies a curve that changes stiffness or strength of the soil.
void Bound::bend(const BoundEffect& curve, double x, WheelContact& contact) {
  if (curve.effect->name == "empirical") return;
  const double factor = std::exp(std::clamp(curve.curve(x), -3.0, 3.0));
  if (curve.effect->name == "empirical_stiffness") {
    contact.sinkage_modulus *= factor;
  } else {
    contact.cohesion_Pa *= factor;
    contact.tan_friction *= factor;
  }
}

WheelContact Bound::contact(const WheelState& state) const {
  WheelContact contact = contactOf(model_.soil, state.wheel);
  contact.load_N = state.load_N;
  contact.gravity_m_s2 = state.gravity_m_s2;
  contact.slip_angle_rad = std::isfinite(state.slip_angle_rad) ? state.slip_angle_rad : 0.0;
  contact.slip = model_.slip_along_travel ? slipInWheelPlane(state.slip, state.slip_angle_rad) : state.slip;
  contact.rolling = rolling(state, model_.slip_along_travel);
  for (const BoundEffect& e : effects_) {
    if (!applies(*e.effect, state)) continue;
    // The sinkage is not known before the solution; effects that change the contact must not depend on the
    // sinkage, and 0 is passed.
    const double x = covariateOf(*e.effect, state, 0.0);
    if (!std::isfinite(x)) continue;
    if (!e.form) {
      bend(e, x, contact);
    } else if (e.form->act && beyond(e, x)) {
      const WheelState edge = atEdge(e, state);
      const double rolled = contact.rolling;
      contact.rolling = rolling(edge, model_.slip_along_travel);
      e.form->act({e.effect->parameters.data(), edge, edge.covariate(e.effect->covariate)}, contact);
      contact.rolling = rolled;
    } else if (e.form->act) {
      e.form->act({e.effect->parameters.data(), state, x}, contact);
    }
  }
  contact.slip = std::clamp(contact.slip, -1.0, 1.0);
  return contact;
}

Reading Bound::reading(const WheelState& state, const WheelContact& contact,
                       const ContactForces& forces) const {
  Reading reading{.load_N = state.load_N,
                  .radius_m = state.wheel.radius_m,
                  .sinkage_m = forces.sinkage_m,
                  .dug_m = forces.dug_m,
                  .torque_Nm = forces.torque_Nm,
                  .drawbar_pull_N = forces.drawbar_pull_N,
                  .side_force_N = forces.side_force_N};
  if (model_.base == BaseModel::LinearFormula) {
    Reading from = reading;
    if (std::isfinite(state.measured_torque_Nm)) from.torque_Nm = state.measured_torque_Nm;
    if (std::isfinite(state.measured_sinkage_m)) from.sinkage_m = state.measured_sinkage_m;
    reading.drawbar_pull_N =
        reading.load_N * (from.scaled(Channel::Torque) - from.scaled(Channel::Sinkage) - 0.1);
  }
  for (const BoundEffect& e : effects_) {
    if (!e.form || !e.form->read || !applies(*e.effect, state)) continue;
    const double x = covariateOf(*e.effect, state, reading.sinkage_m);
    if (!std::isfinite(x)) continue;
    if (beyond(e, x)) {
      const WheelState edge = atEdge(e, state);
      e.form->read({e.effect->parameters.data(), edge, edge.covariate(e.effect->covariate)}, contact,
                   reading);
    } else {
      e.form->read({e.effect->parameters.data(), state, x}, contact, reading);
    }
  }
  const double sinkage = reading.sinkage_m;
  for (const BoundEffect& e : effects_) {
    if (e.effect->name != "empirical" || !applies(*e.effect, state)) continue;
    const double x = covariateOf(*e.effect, state, sinkage);
    if (std::isfinite(x))
      reading.addScaled(e.effect->channel, e.curve(x) * e.effect->sense(contact.slip_angle_rad));
  }
  return reading;
}

}  // namespace

double slipInWheelPlane(double slip_along_travel, double slip_angle_rad) {
  if (slip_along_travel <= -1.0) return -1.0;  // locked at any slip angle
  const double q = travelRatio(slip_along_travel) * cosineOf(slip_angle_rad);
  return q <= 1.0 ? 1.0 - q : 1.0 / q - 1.0;
}

Reading predict(const RefinedModel& model, const WheelState& state, double* entry_guess_rad) {
  const Bound bound{model};
  const WheelContact contact = bound.contact(state);
  const ContactForces forces = solveContact(contact, entry_guess_rad ? *entry_guess_rad : 0.0);
  if (entry_guess_rad) *entry_guess_rad = forces.static_entry_rad;
  return bound.reading(state, contact, forces);
}

std::vector<Reading> predict(const RefinedModel& model, std::span<const WheelState> states,
                             SolvedContacts& solved) {
  const Bound bound{model};
  std::vector<WheelContact> contacts;
  contacts.reserve(states.size());
  for (const WheelState& state : states) contacts.push_back(bound.contact(state));
  solveContacts(std::move(contacts), solved);
  std::vector<Reading> readings;
  readings.reserve(states.size());
  for (std::size_t k = 0; k < states.size(); ++k)
    readings.push_back(bound.reading(states[k], solved.contacts[k], solved.forces[k]));
  return readings;
}

RefinedModel withoutSensors(RefinedModel model) {
  std::erase_if(model.effects, [](const Effect& e) {
    const EffectForm* form = findEffect(e.name);
    return form && form->of_sensor;
  });
  model.fitted.clear();  // would contain indices of removed effects
  model.covariance.clear();
  return model;
}

const std::vector<SoilParameter>& soilParameters() {
  static const std::vector<SoilParameter> all{
      {"cohesion_Pa", 0.0, 1e5, 500.0, [](const Soil& s) { return s.cohesion_Pa; },
       [](Soil& s, double v) { s.cohesion_Pa = v; }},
      {"friction_angle_rad", 0.05, 1.2, 0.05, [](const Soil& s) { return s.friction_angle_rad; },
       [](Soil& s, double v) { s.friction_angle_rad = v; }},
      {"sinkage_exponent", 0.1, 3.0, 0.1, [](const Soil& s) { return s.sinkage_exponent; },
       [](Soil& s, double v) { s.sinkage_exponent = v; }},
      {"log_stiffness", -8.0, 8.0, 0.2, [](const Soil&) { return 0.0; },
       [](Soil& s, double v) {  // v is a step, as get() always returns 0
         s.cohesive_modulus *= std::exp(v);
         s.frictional_modulus *= std::exp(v);
       }},
      {"shear_modulus_m", 5e-4, 0.3, 0.003, [](const Soil& s) { return s.shear_modulus_m; },
       [](Soil& s, double v) { s.shear_modulus_m = v; }},
      {"c1", 0.0, 1.0, 0.05, [](const Soil& s) { return s.c1; }, [](Soil& s, double v) { s.c1 = v; }},
      {"c2", -1.0, 1.0, 0.05, [](const Soil& s) { return s.c2; }, [](Soil& s, double v) { s.c2 = v; }},
      {"density_kg_m3", 200.0, 5000.0, 100.0, [](const Soil& s) { return s.density_kg_m3; },
       [](Soil& s, double v) { s.density_kg_m3 = v; }},
      {"digging_exponent", 0.0, 2.0, 0.1, [](const Soil& s) { return s.digging_exponent; },
       [](Soil& s, double v) { s.digging_exponent = v; }},
      {"side_bulldozing", 0.0, 10.0, 0.3, [](const Soil& s) { return s.side_bulldozing; },
       [](Soil& s, double v) { s.side_bulldozing = v; }},
  };
  return all;
}

double value(const RefinedModel& model, const FittedParameter& p) {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.effect < 0) return soilParameters()[index].get(model.soil);
  return model.effects[static_cast<std::size_t>(p.effect)].parameters[index];
}

void setValue(RefinedModel& model, const FittedParameter& p, double value) {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.effect < 0)
    soilParameters()[index].set(model.soil, value);
  else
    model.effects[static_cast<std::size_t>(p.effect)].parameters[index] = value;
}

namespace {

double step(const RefinedModel& model, const FittedParameter& p) {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.effect < 0) return 0.01 * soilParameters()[index].scale;
  const Effect& effect = model.effects[static_cast<std::size_t>(p.effect)];
  const EffectForm* form = findEffect(effect.name);
  return form ? 0.02 * std::abs(form->parameters[index].typical) + 1e-9 : 1e-3;
}

/// Central difference of each scaled channel between two readings.
using Slope = std::array<double, kChannels>;
Slope slope(const Reading& high, const Reading& low, double width) {
  Slope s{};
  for (int c = 0; c < kChannels; ++c)
    s[static_cast<std::size_t>(c)] =
        (high.scaled(static_cast<Channel>(c)) - low.scaled(static_cast<Channel>(c))) / width;
  return s;
}

Slope slipSlope(const RefinedModel& model, const WheelState& state) {
  WheelState high = state, low = state;
  high.slip = std::min(1.0, state.slip + 0.005);
  low.slip = std::max(-1.0, state.slip - 0.005);
  return slope(predict(model, high), predict(model, low), high.slip - low.slip);
}

Slope loadSlope(const RefinedModel& model,
                const WheelState& state) {  // by relative load, forces divided by the unchanged load
  WheelState high = state, low = state;
  high.load_N *= 1.01;
  low.load_N /= 1.01;
  Reading a = predict(model, high), b = predict(model, low);
  a.load_N = b.load_N = state.load_N;
  return slope(a, b, 2.0 * std::log(1.01));
}

}  // namespace

double SensorNoise::slipStd(double slip) const {
  // (T2)
  return std::hypot(slip_absolute, std::min(slip_relative * std::abs(slip), std::max(1.0 + slip, 0.0)));
}

Prediction predictWithStd(const RefinedModel& model, const WheelState& state) {
  Prediction out{.mean = predict(model, state)};
  std::array<double, kChannels> variance{};
  const auto& noise = model.noise;
  const double slip_var = squared(noise.slipStd(state.slip));
  const Slope by_slip = slipSlope(model, state), by_load = loadSlope(model, state);
  std::vector<Slope> by_parameter;
  if (!model.covariance.empty())
    for (const FittedParameter& p : model.fitted) {
      RefinedModel moved = model;
      const double h = step(model, p);
      setValue(moved, p, value(model, p) + h);
      by_parameter.push_back(slope(predict(moved, state), out.mean, h));
    }
  for (std::size_t c = 0; c < kChannels; ++c) {
    variance[c] = squared(noise.absolute[c] / out.mean.denominator(static_cast<Channel>(c))) +
                  squared(noise.relative[c] * out.mean.scaled(static_cast<Channel>(c))) +
                  slip_var * squared(by_slip[c]) + squared(noise.load_relative * by_load[c]);
    for (std::size_t i = 0; i < by_parameter.size(); ++i)
      for (std::size_t j = 0; j < by_parameter.size(); ++j)
        variance[c] +=
            by_parameter[i][c] * model.covariance[i * by_parameter.size() + j] * by_parameter[j][c];
    out.scaled_std[c] = std::sqrt(std::max(0.0, variance[c]));
  }
  return out;
}

}  // namespace talus::terramech
