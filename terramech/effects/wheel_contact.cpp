#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/side_bulldozing.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/effects/wheel_contact.hpp>

namespace talus::terramech {
namespace {

constexpr double kDeepest = 0.5 * std::numbers::pi;

/// ContactLaw of wong_reece.hpp with the changes by effects. `pressure_scale` reduces the pressure under a
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

ShearDisplacement straight(const WheelContact& c, double entry) {
  return ShearDisplacement{{c.shear_radius_m, c.slip, entry}};
}

SideSlipDisplacement sideways(const WheelContact& c, double entry) {
  return SideSlipDisplacement{{.shear_radius_m = c.shear_radius_m,
                               .radius_m = c.radius_m,
                               .slip = c.slip,
                               .slip_angle_rad = c.slip_angle_rad,
                               .entry_angle_rad = entry}};
}

template <class Rule>
RimForces forcesBy(const WheelContact& c, double entry, double pressure_scale) {
  const EffectLaw law{c, pressure_scale};
  if (c.slip_angle_rad == 0.0) return rimForces<Rule>(law, wheelOf(c), straight(c, entry));
  return rimForces<Rule>(law, wheelOf(c), sideways(c, entry));
}

template <class Rule>
std::optional<RimEquilibrium> carryBy(const WheelContact& c, double guess, double growth) {
  const EffectLaw law{c};
  const RimLoad wanted{.load_N = c.load_N,
                       .slip = c.slip,
                       .first_guess = guess > 0.0 ? guess : 0.3,
                       .growth = growth > 0.0 ? growth : 2.0 * c.sinkage_exponent + 1.0,
                       .tolerance = 1e-9};
  if (c.slip_angle_rad == 0.0)
    return findEquilibrium<Rule>(law, wheelOf(c), wanted, [&](double entry) { return straight(c, entry); });
  return findEquilibrium<Rule>(law, wheelOf(c), wanted, [&](double entry) { return sideways(c, entry); });
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

double sinkageOf(double radius_m, double entry) {
  const double half = std::sin(0.5 * entry);
  return 2.0 * radius_m * half * half;
}

double entryOf(double radius_m, double sinkage_m) {
  return sinkage_m >= radius_m ? kDeepest : 2.0 * std::asin(std::sqrt(0.5 * sinkage_m / radius_m));
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
  const double z0 = sinkageOf(c.radius_m, static_entry);
  if (carried && !digs(c)) {
    ContactForces forces = forcesOf(carried->forces, z0, static_entry, static_entry);
    forces.growth = carried->growth;
    return forces;
  }
  const double dug = (c.sinkage_gain - 1.0) * z0 + c.dug_m;
  const double deeper = c.ploughed_m > 0.0 ? std::hypot(dug, c.ploughed_m) : dug;
  const double z = std::clamp(z0 + deeper + c.extra_sinkage_m, 1e-6 * c.radius_m, 1.95 * c.radius_m);
  const double entry = entryOf(c.radius_m, z);
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

}  // namespace talus::terramech
