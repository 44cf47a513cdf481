#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

namespace talus::terramech {

namespace {

/// Returns (W, T, DP) of thesis Eqs. C.8 to C.10 for parameters `p` in the order of ContactColumn; Number is double, or
/// a number with derivatives.
template <class Number>
Eigen::Matrix<Number, 3, 1> forcesBy(const std::array<Number, kContactColumns>& p, const ContactSoil& soil,
                                     const Wheel& wheel) {
  using std::asin, std::exp, std::log, std::sin, std::cos, std::sqrt, std::tan;
  constexpr auto kRule = gaussLegendre<10>();
  const double r = wheel.radius_m;
  const Number entry = 2.0 * asin(sqrt(p[kSinkage] / (2.0 * r))), sin_entry = sin(entry),
               travel = 1.0 - p[kSlip];
  const Number peak = soil.c1 + soil.c2 * p[kSlip], tan_phi = tan(p[kFriction]);
  Eigen::Matrix<Number, 3, 1> sum = Eigen::Matrix<Number, 3, 1>::Zero();
  for (std::size_t k = 0; k < kRule.node.size(); ++k) {
    const double t = kRule.node[k], s = t * t * t, ds = 3.0 * t * t * kRule.weight[k];
    const Number front = entry * (1.0 - (1.0 - peak) * s);
    const Number depth = 2.0 * r * sin(0.5 * (entry + front)) * sin(0.5 * (entry - front));
    const Number sigma = p[kModulus] * exp(p[kExponent] * log(depth));
    const auto add = [&](const Number& theta, const Number& arc) {
      const Number sine = sin(theta), cosine = cos(theta);
      const Number j = r * ((entry - theta) - travel * (sin_entry - sine));
      const Number tau = (p[kCohesion] + sigma * tan_phi) * (1.0 - exp(-j / p[kShear]));
      sum[kLoad] += arc * (sigma * cosine + tau * sine);
      sum[kTorque] += arc * tau;
      sum[kPull] += arc * (tau * cosine - sigma * sine);
    };
    add(front, (1.0 - peak) * entry * ds);
    add(peak * entry * s, peak * entry * ds);  // the mirror point behind the peak has the same sigma (C.3)
  }
  const double area = r * wheel.width_m;
  return {area * sum[kLoad], area * r * sum[kTorque], area * sum[kPull]};
}

std::array<double, kContactColumns> parametersOf(const ContactSoil& soil, const ContactState& state) {
  return {soil.cohesion_Pa,
          soil.friction_angle_rad,
          soil.sinkage_exponent,
          soil.sinkage_modulus,
          soil.shear_modulus_m,
          state.sinkage_m,
          state.slip};
}

}  // namespace

Soil soilOf(const ContactSoil& contact) {
  return {.name = "contact",
          .cohesion_Pa = contact.cohesion_Pa,
          .friction_angle_rad = contact.friction_angle_rad,
          .sinkage_exponent = contact.sinkage_exponent,
          .cohesive_modulus = 0.0,
          .frictional_modulus = contact.sinkage_modulus,
          .shear_modulus_m = contact.shear_modulus_m,
          .c1 = contact.c1,
          .c2 = contact.c2};
}

ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state) {
  return forcesBy(parametersOf(soil, state), soil, wheel);
}

ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state,
                          ContactDerivative& derivative) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, kContactColumns, 1>>;
  const auto parameters = parametersOf(soil, state);
  std::array<Dual, kContactColumns> p;
  for (std::size_t k = 0; k < p.size(); ++k) p[k] = Dual(parameters[k], kContactColumns, static_cast<int>(k));
  const auto forces = forcesBy(p, soil, wheel);
  for (int row = 0; row < 3; ++row) derivative.row(row) = forces[row].derivatives().transpose();
  return {forces[kLoad].value(), forces[kTorque].value(), forces[kPull].value()};
}

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
