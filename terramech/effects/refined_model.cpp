#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

const char* name(Channel channel) {
  constexpr const char* kNames[] = {"drawbar_pull_over_load", "sinkage_over_radius",
                                    "torque_over_load_radius", "side_force_over_load"};
  return kNames[static_cast<std::size_t>(channel)];
}

double Reading::denominator(Channel channel) const {
  return channel == Channel::Sinkage ? radius_m : channel == Channel::Torque ? load_N * radius_m : load_N;
}

namespace {

constexpr double Reading::*kReadings[] = {&Reading::drawbar_pull_N, &Reading::sinkage_m, &Reading::torque_Nm,
                                          &Reading::side_force_N};

}  // namespace

double& Reading::operator[](Channel channel) {
  return this->*kReadings[static_cast<std::size_t>(channel)];
}

double Reading::scaled(Channel channel) const {
  return this->*kReadings[static_cast<std::size_t>(channel)] / denominator(channel);
}

namespace {

constexpr double kDeepest = 0.5 * std::numbers::pi;

/// ContactLaw of wheel_on_soil.hpp with the changes by effects. `pressure_scale` reduces the pressure under a
/// wheel that dug deeper than its load requires.
class EffectLaw {
 public:
  explicit EffectLaw(const WheelContact& c, double pressure_scale = 1.0)
      : c_(c), peak_fraction_(std::clamp(c.c1 + c.c2 * c.slip, 0.02, 0.98)), scale_(pressure_scale) {}

  double pressure_Pa(double depth_m) const {
    double p = c_.sinkage_modulus * std::pow(depth_m, c_.sinkage_exponent);
    if (depth_m > c_.hard_depth_m) p += c_.hard_modulus_Pa_m * (depth_m - c_.hard_depth_m);
    return scale_ * p;
  }

  double shear_Pa(double normal_Pa, double displacement_m) const {
    return std::copysign(strength_Pa(normal_Pa, std::abs(displacement_m)), displacement_m);
  }

  Tangent shear_Pa(double normal_Pa, const Tangent& displacement_m) const {
    // Displacements are in metres: the overflow guards of std::hypot are unnecessary.
    const double path = std::sqrt(displacement_m.along * displacement_m.along +
                                  displacement_m.across * displacement_m.across);
    return alongDisplacement(strength_Pa(normal_Pa, path), displacement_m, path);
  }

  double peak_rad(double entry_rad) const { return peak_fraction_ * entry_rad; }

  double exit_rad(double entry_rad) const {
    return c_.rebound > 0.0 ? -2.0 * std::asin(std::sqrt(c_.rebound) * std::sin(0.5 * entry_rad)) : 0.0;
  }

 private:
  double strength_Pa(double normal_Pa, double path_m) const {
    return (c_.cohesion_Pa + normal_Pa * c_.tan_friction) * (1.0 - std::exp(-path_m / c_.shear_modulus_m));
  }

  const WheelContact& c_;
  double peak_fraction_, scale_;
};

Wheel wheelOf(const WheelContact& c) {
  return {.radius_m = c.radius_m, .width_m = c.width_m};
}

/// Calls `solve` with a function that returns the shear displacement of the rim at an entry angle.
template <class Solve>
auto withDisplacement(const WheelContact& c, const Solve& solve) {
  if (c.slip_angle_rad == 0.0)
    return solve([&](double entry) { return ShearDisplacement{{c.shear_radius_m, c.slip, entry}}; });
  return solve([&](double entry) {
    return SideSlipDisplacement{{.shear_radius_m = c.shear_radius_m,
                                 .radius_m = c.radius_m,
                                 .slip = c.slip,
                                 .slip_angle_rad = c.slip_angle_rad,
                                 .entry_angle_rad = entry}};
  });
}

template <class Rule>
RimForces forcesBy(const WheelContact& c, double entry, double pressure_scale) {
  const EffectLaw law{c, pressure_scale};
  return withDisplacement(c, [&](const auto& at) { return rimForces<Rule>(law, wheelOf(c), at(entry)); });
}

template <class Rule>
std::optional<RimEquilibrium> carryBy(const WheelContact& c, double guess, double growth) {
  const EffectLaw law{c};
  const RimLoad wanted{.load_N = c.load_N,
                       .slip = c.slip,
                       .first_guess = guess > 0.0 ? guess : 0.3,
                       .growth = growth > 0.0 ? growth : 2.0 * c.sinkage_exponent + 1.0,
                       .tolerance = 1e-9};
  return withDisplacement(c,
                          [&](const auto& at) { return findEquilibrium<Rule>(law, wheelOf(c), wanted, at); });
}

/// Forces at an entry angle. The shear stress of a braked rim, with long displacements, rises steeply at the
/// entry and needs the finer rule.
RimForces forcesAt(const WheelContact& c, double entry, double pressure_scale) {
  return c.slip < 0.0 ? forcesBy<BrakedRimRule>(c, entry, pressure_scale)
                      : forcesBy<QuickRimRule>(c, entry, pressure_scale);
}

std::optional<RimEquilibrium> carry(const WheelContact& c, double guess, double growth) {
  return c.slip < 0.0 ? carryBy<BrakedRimRule>(c, guess, growth) : carryBy<QuickRimRule>(c, guess, growth);
}

double entryOf(const WheelContact& c, double sinkage_m) {
  return sinkage_m >= c.radius_m ? kDeepest : entryAngle_rad(wheelOf(c), sinkage_m);
}

/// Forces at an imposed entry angle. The pressure is scaled to carry the load; every force is linear in the
/// scale.
RimForces imposed(const WheelContact& c, double entry) {
  const RimForces full = forcesAt(c, entry, 1.0), none = forcesAt(c, entry, 0.0);
  const double scale = std::max(0.0, c.load_N - none.load_N) / std::max(full.load_N - none.load_N, 1e-300);
  const auto at = [&](double RimForces::*force) { return none.*force + scale * (full.*force - none.*force); };
  return {at(&RimForces::load_N), at(&RimForces::torque_Nm), at(&RimForces::drawbar_pull_N),
          at(&RimForces::side_force_N)};
}

ContactForces forcesOf(const RimForces& forces, double sinkage_m, double entry, double static_entry) {
  return {.sinkage_m = sinkage_m,
          .entry_angle_rad = entry,
          .static_entry_rad = static_entry,
          .torque_Nm = forces.torque_Nm,
          .drawbar_pull_N = forces.drawbar_pull_N,
          .side_force_N = forces.side_force_N};
}

bool digs(const WheelContact& c) {
  return c.sinkage_gain != 1.0 || c.dug_m != 0.0 || c.ploughed_m != 0.0 || c.extra_sinkage_m != 0.0;
}

bool isPlain(const WheelContact& c) {
  return c.rebound == 0.0 && c.shear_radius_m == c.radius_m && c.hard_modulus_Pa_m == 0.0 && !digs(c);
}

WheelCase caseOf(const WheelContact& c) {
  return {.cohesion_Pa = c.cohesion_Pa,
          .friction_angle_rad = std::atan(c.tan_friction),
          .sinkage_exponent = c.sinkage_exponent,
          .sinkage_modulus = c.sinkage_modulus,
          .shear_modulus_m = c.shear_modulus_m,
          .c1 = c.c1,
          .c2 = c.c2,
          .wheel_radius_m = c.radius_m,
          .wheel_width_m = c.width_m,
          .load_N = c.load_N,
          .slip = c.slip,
          .slip_angle_rad = c.slip_angle_rad,
          .density_kg_m3 = c.density_kg_m3,
          .gravity_m_s2 = c.gravity_m_s2,
          .digging_exponent = c.digging_exponent,
          .side_bulldozing = c.side_bulldozing,
          .slip_sinkage_exponent = c.slip_sinkage_exponent};
}

/// Returns the contact with the sinkage exponent increased by slip and slip angle.
WheelContact dug(WheelContact c) {
  c.sinkage_exponent += c.slip_sinkage_exponent * std::abs(c.slip);
  if (c.slip_angle_rad != 0.0)
    c.sinkage_exponent += c.digging_exponent * (resultantSlip(c.slip, c.slip_angle_rad) - std::abs(c.slip));
  return c;
}

double bulldozing_N(const WheelContact& c, double entry) {
  const Hegedus push = hegedus({.cohesion_Pa = c.cohesion_Pa,
                                .tan_friction = c.tan_friction,
                                .weight_N_m3 = c.density_kg_m3 * c.gravity_m_s2});
  const double beta = std::clamp(c.slip_angle_rad, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
  return -c.side_bulldozing * std::sin(beta) *
         faceResistance_N(push, {.radius_m = c.radius_m, .entry_angle_rad = entry});
}

ContactForces solveRim(const WheelContact& c, double entry_guess_rad, double growth) {
  const auto carried = carry(c, entry_guess_rad, growth);
  const double static_entry = carried ? carried->entry_angle_rad : kDeepest;
  const double z0 = sinkage_m(wheelOf(c), static_entry);
  if (carried && !digs(c)) {
    ContactForces forces = forcesOf(carried->forces, z0, static_entry, static_entry);
    forces.growth = carried->growth;
    return forces;
  }
  const double dug = (c.sinkage_gain - 1.0) * z0 + c.dug_m;
  const double deeper = c.ploughed_m > 0.0 ? std::hypot(dug, c.ploughed_m) : dug;
  const double z = std::clamp(z0 + deeper + c.extra_sinkage_m, 1e-6 * c.radius_m, 1.95 * c.radius_m);
  const double entry = entryOf(c, z);
  WheelContact filled = c;
  filled.rebound = std::min(1.0, c.rebound + c.rear_fill * std::max(0.0, dug) / z);
  ContactForces forces = forcesOf(imposed(filled, entry), z, entry, static_entry);
  forces.growth = carried ? carried->growth : 0.0;
  forces.dug_m = std::clamp(deeper > 0.0 ? dug * dug / deeper : 0.0, 0.0, z);
  return forces;
}

}  // namespace

WheelContact contactOf(const Soil& soil, const Wheel& wheel) {
  WheelContact c;
  c.radius_m = c.shear_radius_m = wheel.radius_m;
  c.width_m = wheel.width_m;
  c.sinkage_modulus = sinkageModulus(soil, wheel.width_m);
  c.sinkage_exponent = soil.sinkage_exponent;
  c.cohesion_Pa = soil.cohesion_Pa;
  c.tan_friction = std::tan(soil.friction_angle_rad);
  c.shear_modulus_m = soil.shear_modulus_m;
  c.density_kg_m3 = soil.density_kg_m3;
  c.slip_sinkage_exponent = soil.slip_sinkage_exponent;
  c.digging_exponent = soil.digging_exponent;
  c.side_bulldozing = soil.side_bulldozing;
  c.c1 = soil.c1;
  c.c2 = soil.c2;
  return c;
}

ContactForces solveContact(const WheelContact& contact, double entry_guess_rad, double growth) {
  ContactForces forces = solveRim(dug(contact), entry_guess_rad, growth);
  if (contact.slip_angle_rad != 0.0) forces.side_force_N += bulldozing_N(contact, forces.entry_angle_rad);
  return forces;
}

void solveContacts(std::vector<WheelContact> contacts, SolvedContacts& solved) {
  const bool new_rows = solved.contacts.size() != contacts.size();
  if (new_rows) solved.forces.assign(contacts.size(), {});
  std::vector<std::size_t> plain;
  std::vector<WheelCase> cases;
  const auto slowly = [&](std::size_t k) {
    solved.forces[k] = solveContact(contacts[k], solved.forces[k].static_entry_rad, solved.forces[k].growth);
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (!new_rows && contacts[k] == solved.contacts[k]) continue;
    const WheelCase one = caseOf(contacts[k]);
    if (!isPlain(contacts[k]) || !isFastCase(one)) {
      slowly(k);
      continue;
    }
    plain.push_back(k);
    cases.push_back(one);
  }
  std::vector<WheelForces> batch(cases.size());
  equilibria(cases, batch, BatchKernel::Best, Leftover::Nan);
  for (std::size_t j = 0; j < plain.size(); ++j) {
    const WheelForces& f = batch[j];
    if (std::isfinite(f.drawbar_pull_N))
      solved.forces[plain[j]] = {.sinkage_m = f.sinkage_m,
                                 .entry_angle_rad = f.entry_angle_rad,
                                 .static_entry_rad = f.entry_angle_rad,
                                 .torque_Nm = f.torque_Nm,
                                 .drawbar_pull_N = f.drawbar_pull_N,
                                 .side_force_N = f.side_force_N};
    else
      slowly(plain[j]);
  }
  solved.contacts = std::move(contacts);
}

namespace {

/// Telemetry column that is a field of WheelState or of its wheel.
struct Column {
  const char* name;
  double WheelState::*field = nullptr;
  double Wheel::*of_wheel = nullptr;

  double value(const WheelState& s) const {
    return field ? s.*field : of_wheel ? s.wheel.*of_wheel : static_cast<double>(s.wheel.grouser_count);
  }
  void set(WheelState& s, double value) const {
    if (field)
      s.*field = value;
    else if (of_wheel)
      s.wheel.*of_wheel = value;
    else
      s.wheel.grouser_count = static_cast<int>(std::lround(value));
  }
};

constexpr Column kColumns[] = {{"slip", &WheelState::slip},
                               {"slip_angle_rad", &WheelState::slip_angle_rad},
                               {"load_N", &WheelState::load_N},
                               {"speed_mps", &WheelState::speed_mps},
                               {"rim_speed_mps", &WheelState::rim_speed_mps},
                               {"time_s", &WheelState::time_s},
                               {"pass_index", &WheelState::pass_index},
                               {"slope_rad", &WheelState::slope_rad},
                               {"wheel_radius_m", nullptr, &Wheel::radius_m},
                               {"wheel_width_m", nullptr, &Wheel::width_m},
                               {"grouser_height_m", nullptr, &Wheel::grouser_height_m},
                               {"grouser_count"}};

}  // namespace

double WheelState::covariate(std::string_view name) const {
  for (const Column& column : kColumns)
    if (name == column.name) return column.value(*this);
  for (const auto& [key, value] : extra)
    if (key == name) return value;
  for (const auto& [key, text] : group)
    if (key == name) return 1.0;
  if (const auto star = name.find('*'); star != std::string_view::npos)
    return covariate(name.substr(0, star)) * covariate(name.substr(star + 1));
  return name == "constant" ? 1.0 : kUnknown;
}

void WheelState::setCovariate(std::string_view name, double value) {
  for (const Column& column : kColumns)
    if (name == column.name) return column.set(*this, value);
  for (auto& [key, number] : extra)
    if (key == name) number = value;
}

std::string_view WheelState::label(std::string_view column) const {
  for (const auto& [key, value] : group)
    if (key == column) return value;
  return {};
}

const std::vector<std::string>& stateColumns() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Column& column : kColumns) all.emplace_back(column.name);
    return all;
  }();
  return names;
}

double Effect::sense(double slip_angle_rad) const {
  return channel == Channel::SideForce ? std::sin(slip_angle_rad) : 1.0;
}

bool knowsPasses(std::span<const Effect> effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& e) { return e.covariate == "pass_index"; });
}

const std::vector<EffectForm>& effectLibrary() {
  static const std::vector<EffectForm> library = [] {
    std::vector<EffectForm> all;
    for (auto part : {detail::contactEffects, detail::diggingEffects, detail::forceEffects,
                      detail::sensorEffects, detail::driftEffects})
      for (EffectForm& form : part()) all.push_back(std::move(form));
    return all;
  }();
  return library;
}

const EffectForm* findEffect(std::string_view name) {
  static const std::unordered_map<std::string_view, const EffectForm*> by_name = [] {
    std::unordered_map<std::string_view, const EffectForm*> all;
    for (const EffectForm& form : effectLibrary()) all.emplace(form.name, &form);
    return all;
  }();
  for (const std::string_view word : {"moisture_", "temperature_"})  // prefixes in model files of version 0.1
    if (name.starts_with(word)) name.remove_prefix(word.size());
  const auto found = by_name.find(name);
  return found == by_name.end() ? nullptr : found->second;
}

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

double SoilParameter::get(const Soil& soil) const {
  return field ? soil.*field : 0.0;
}

void SoilParameter::set(Soil& soil, double value) const {
  if (field) {
    soil.*field = value;
  } else {  // value is a step, as get() returns 0
    soil.cohesive_modulus *= std::exp(value);
    soil.frictional_modulus *= std::exp(value);
  }
}

const std::vector<SoilParameter>& soilParameters() {
  static const std::vector<SoilParameter> all{
      {"cohesion_Pa", 0.0, 1e5, 500.0, &Soil::cohesion_Pa},
      {"friction_angle_rad", 0.05, 1.2, 0.05, &Soil::friction_angle_rad},
      {"sinkage_exponent", 0.1, 3.0, 0.1, &Soil::sinkage_exponent},
      {"log_stiffness", -8.0, 8.0, 0.2, nullptr},
      {"shear_modulus_m", 5e-4, 0.3, 0.003, &Soil::shear_modulus_m},
      {"c1", 0.0, 1.0, 0.05, &Soil::c1},
      {"c2", -1.0, 1.0, 0.05, &Soil::c2},
      {"density_kg_m3", 200.0, 5000.0, 100.0, &Soil::density_kg_m3},
      {"digging_exponent", 0.0, 2.0, 0.1, &Soil::digging_exponent},
      {"side_bulldozing", 0.0, 10.0, 0.3, &Soil::side_bulldozing}};
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
