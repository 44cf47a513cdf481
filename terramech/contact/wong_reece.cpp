#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

double checkedModulus(const Soil& soil, const Wheel& wheel) {
  validate(soil);
  validate(wheel);
  const double k = sinkageModulus(soil, wheel.width_m);
  RangeCheck{"soil '" + soil.name + "'"}.above("cohesive_modulus / width_m + frictional_modulus", k, 0.0);
  return k;
}

double checkedPeak(const Soil& soil, double slip) {
  const double fraction = soil.c1 + soil.c2 * slip;
  if (fraction < 0.0 || fraction > 1.0)
    throw std::domain_error("soil '" + soil.name + "': the stress peak c1 + c2 slip = " +
                            std::to_string(fraction) + " lies outside the contact, [0, 1]");
  return fraction;
}

void check(const WheelOperation& operation) {
  const RangeCheck range{"wheel operation"};
  range.within("slip", operation.slip, {-1.0, 1.0});
  range.within("rebound", operation.rebound, {0.0, 0.999});
  range.within("slip_angle_rad", operation.slip_angle_rad, {-0.5 * std::numbers::pi, 0.5 * std::numbers::pi});
  range.above("gravity_m_s2", operation.gravity_m_s2, 0.0);
}

WheelForces wheelForces(const Wheel& wheel, const RimEquilibrium& rim) {
  return {sinkage_m(wheel, rim.entry_angle_rad), rim.entry_angle_rad, rim.forces.torque_Nm,
          rim.forces.drawbar_pull_N, rim.forces.side_force_N};
}

double digging(const Soil& soil, const WheelOperation& operation) {
  const double along = std::abs(operation.slip), grown = soil.slip_sinkage_exponent * along;
  if (operation.slip_angle_rad == 0.0) return grown;
  return grown + soil.digging_exponent * (resultantSlip(operation.slip, operation.slip_angle_rad) - along);
}

/// Returns the bulldozing force of the soil beside the wheel, a component of the side force [N].
double bulldozing_N(const Soil& soil, const Wheel& wheel, const WheelOperation& operation, double entry_rad) {
  const Hegedus push = hegedus({.cohesion_Pa = soil.cohesion_Pa,
                                .tan_friction = std::tan(soil.friction_angle_rad),
                                .weight_N_m3 = soil.density_kg_m3 * operation.gravity_m_s2});
  return -soil.side_bulldozing * std::sin(operation.slip_angle_rad) *
         faceResistance_N(push, {.radius_m = wheel.radius_m, .entry_angle_rad = entry_rad});
}

SideSlipDisplacement sideways(const Wheel& wheel, const WheelOperation& operation, double entry_rad) {
  return SideSlipDisplacement{{.shear_radius_m = wheel.radius_m,
                               .radius_m = wheel.radius_m,
                               .slip = operation.slip,
                               .slip_angle_rad = operation.slip_angle_rad,
                               .entry_angle_rad = entry_rad}};
}

RimLoad wantedLoad(const WongReece& law, double exponent, const WheelOperation& operation) {
  return {.load_N = operation.load_N,
          .slip = operation.slip,
          .first_guess = law.smallAngleEntry_rad(operation.load_N),
          .growth = 2.0 * exponent + 1.0};
}

}  // namespace

WongReece::WongReece(const Soil& soil, const Wheel& wheel, const WheelOperation& operation)
    : modulus_(checkedModulus(soil, wheel)),
      exponent_(soil.sinkage_exponent + digging(soil, operation)),
      cohesion_Pa_(shearGain(wheel) * soil.cohesion_Pa),
      tan_friction_(shearGain(wheel) * std::tan(soil.friction_angle_rad)),
      shear_modulus_m_(soil.shear_modulus_m),
      peak_fraction_(checkedPeak(soil, operation.slip)),
      rebound_(operation.rebound),
      radius_m_(wheel.radius_m),
      width_m_(wheel.width_m) {
  check(operation);
}

double WongReece::pressure_Pa(double depth_m) const {
  return modulus_ * std::pow(depth_m, exponent_);
}

double WongReece::shear_Pa(double normal_Pa, double displacement_m) const {
  const double mobilised = -std::expm1(-std::abs(displacement_m) / shear_modulus_m_);
  return std::copysign((cohesion_Pa_ + normal_Pa * tan_friction_) * mobilised, displacement_m);
}

Tangent WongReece::shear_Pa(double normal_Pa, const Tangent& displacement_m) const {
  const double path = std::hypot(displacement_m.along, displacement_m.across);
  return alongDisplacement(shear_Pa(normal_Pa, path), displacement_m, path);
}

double WongReece::exit_rad(double entry_rad) const {
  if (rebound_ == 0.0) return 0.0;
  // acos(1 - kappa (1 - cos theta_1)) without cancellation.
  return -2.0 * std::asin(std::sqrt(rebound_) * std::sin(0.5 * entry_rad));
}

double WongReece::smallAngleEntry_rad(double load_N) const {
  // W ~ r b k (r/2)^n theta_1^(2n+1) int_0^1 (1 - (1 - (1 - m) s)^2)^n ds; the integrand is evaluated at s =
  // 1/2.
  const double a = 1.0 - 0.5 * (1.0 - peak_fraction_);
  const double shape = std::pow(1.0 - a * a, exponent_);
  const double unit = radius_m_ * width_m_ * modulus_ * std::pow(0.5 * radius_m_, exponent_) * shape;
  return std::pow(load_N / unit, 1.0 / (2.0 * exponent_ + 1.0));
}

WheelForces equilibrium(const Soil& soil, const Wheel& wheel, const WheelOperation& operation) {
  RangeCheck{"wheel operation"}.above("load_N", operation.load_N, 0.0);
  const WongReece law{soil, wheel, operation};
  const RimLoad wanted = wantedLoad(law, soil.sinkage_exponent, operation);
  if (operation.slip_angle_rad == 0.0) return wheelForces(wheel, rimEquilibrium(law, wheel, wanted));
  const auto found = findEquilibrium<FineRimRule>(
      law, wheel, wanted, [&](double entry) { return sideways(wheel, operation, entry); });
  if (!found) detail::throwSunk(operation.load_N);
  WheelForces forces = wheelForces(wheel, *found);
  forces.side_force_N += bulldozing_N(soil, wheel, operation, found->entry_angle_rad);
  return forces;
}

ImposedContact forcesAtEntry(const Soil& soil, const Wheel& wheel, const WheelOperation& operation,
                             double entry_rad) {
  RangeCheck{"wheel operation"}.within("entry angle", entry_rad, {1e-12, 1.5707963267948966});
  const WongReece law{soil, wheel, operation};
  if (operation.slip_angle_rad == 0.0) {
    const RimForces forces =
        rimForces(law, wheel, ShearDisplacement{{wheel.radius_m, operation.slip, entry_rad}});
    return {forces.load_N, wheelForces(wheel, {entry_rad, forces})};
  }
  RimForces forces = rimForces(law, wheel, sideways(wheel, operation, entry_rad));
  forces.side_force_N += bulldozing_N(soil, wheel, operation, entry_rad);
  return {forces.load_N, wheelForces(wheel, {entry_rad, forces})};
}

std::vector<RimStress> stressDistribution(const Soil& soil, const Wheel& wheel,
                                          const WheelOperation& operation, int count) {
  RangeCheck{"stress distribution"}.atLeast("count", count, 2.0);
  const WongReece law{soil, wheel, operation};
  const double entry = equilibrium(soil, wheel, operation).entry_angle_rad;
  const double peak = law.peak_rad(entry), exit = law.exit_rad(entry);
  const bool straight = operation.slip_angle_rad == 0.0;
  const ShearDisplacement displacement{{wheel.radius_m, operation.slip, entry}};
  const SideSlipDisplacement resultant = sideways(wheel, operation, entry);
  std::vector<RimStress> stresses;
  for (int k = 0; k < count; ++k) {
    const double theta = exit + (entry - exit) * k / (count - 1.0);
    // Angle in front of the peak with the same stress, for a point in the rear half (C.3).
    const double mirrored = theta >= peak ? theta : entry - (entry - peak) * (theta - exit) / (peak - exit);
    const double depth = wheel.radius_m * (std::cos(mirrored) - std::cos(entry));
    const double sigma = law.pressure_Pa(depth > 0.0 ? depth : 0.0);
    const double j = theta < entry ? displacement.at_m(theta) : 0.0;
    const double tau = straight ? law.shear_Pa(sigma, j) : law.shear_Pa(sigma, resultant.at_m(theta)).along;
    stresses.push_back({theta, sigma, tau, j});
  }
  return stresses;
}

}  // namespace talus::terramech
