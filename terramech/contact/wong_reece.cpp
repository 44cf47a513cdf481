#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

namespace talus::terramech {

namespace {

constexpr auto kRule = gaussLegendre<10>();

// Quantities of the contact that are the same at every point of the rim.
struct Contact {
  Contact(const ContactSoil& s, const Wheel& w, const ContactState& at)
      : soil(s),
        radius(w.radius_m),
        slip(at.slip),
        theta_1(2.0 * std::asin(std::sqrt(at.sinkage_m / (2.0 * radius)))),
        sin_1(std::sin(theta_1)),
        cos_1(std::cos(theta_1)),
        peak(s.c1 + s.c2 * at.slip),
        tan_friction(std::tan(s.friction_angle_rad)) {}

  const ContactSoil& soil;
  double radius, slip, theta_1, sin_1, cos_1, peak, tan_friction;
};

// Normal stress at fraction s of the arc from an end of contact (s = 0) to the stress peak (s = 1). The point
// theta in front of the peak and its mirror point behind share depth and sigma.
struct Normal {
  Normal(const Contact& c, double fraction) : s(fraction), theta(c.theta_1 * (1.0 - (1.0 - c.peak) * s)) {
    depth = 2.0 * c.radius * std::sin(0.5 * (c.theta_1 + theta)) * std::sin(0.5 * (c.theta_1 - theta));
    log_depth = std::log(depth);
    sigma = c.soil.sinkage_modulus * std::exp(c.soil.sinkage_exponent * log_depth);
  }

  double s, theta, depth, log_depth, sigma;
};

// One point of the rim: stresses, and the arc d theta [rad] that the point represents.
struct Point {
  Point(const Contact& c, const Normal& n, double angle, double strip)
      : theta(angle), weight(strip), sine(std::sin(angle)), cosine(std::cos(angle)) {
    j = c.radius * ((c.theta_1 - theta) - (1.0 - c.slip) * (c.sin_1 - sine));
    left = std::exp(-j / c.soil.shear_modulus_m);
    strength = c.soil.cohesion_Pa + n.sigma * c.tan_friction;
    tau = strength * (1.0 - left);
  }

  ForceVector forces(double sigma) const {
    return {sigma * cosine + tau * sine, tau, tau * cosine - sigma * sine};
  }

  double theta, weight, sine, cosine, j, left, strength, tau;
};

// Derivatives at one rim point by one variable: of the arc (relative), of theta and of the stresses.
struct Motion {
  double weight = 0.0;
  double theta = 0.0;
  double sigma = 0.0;
  double tau = 0.0;
};

void addMotion(const Point& p, double sigma, const Motion& m, Eigen::Ref<Eigen::Vector3d> column) {
  column[kLoad] +=
      p.weight * (m.sigma * p.cosine + m.tau * p.sine + (p.tau * p.cosine - sigma * p.sine) * m.theta);
  column[kTorque] += p.weight * m.tau;
  column[kPull] +=
      p.weight * (m.tau * p.cosine - m.sigma * p.sine - (p.tau * p.sine + sigma * p.cosine) * m.theta);
  if (m.weight != 0.0) column += p.weight * m.weight * p.forces(sigma);
}

// Adds the derivatives at one point by the five soil parameters.
void addSoilMotions(const Contact& c, const Normal& n, const Point& p, ContactDerivative& d) {
  const double shared = 1.0 - p.left;
  const auto throughSigma = [&](double sigma) {
    return Motion{.sigma = sigma, .tau = c.tan_friction * shared * sigma};
  };
  const double secant2 = 1.0 + c.tan_friction * c.tan_friction;
  const double k = c.soil.shear_modulus_m;
  addMotion(p, n.sigma, {.tau = shared}, d.col(kCohesion));
  addMotion(p, n.sigma, {.tau = n.sigma * secant2 * shared}, d.col(kFriction));
  addMotion(p, n.sigma, throughSigma(n.sigma * n.log_depth), d.col(kExponent));
  addMotion(p, n.sigma, throughSigma(n.sigma / c.soil.sinkage_modulus), d.col(kModulus));
  addMotion(p, n.sigma, {.tau = -p.strength * p.left * p.j / (k * k)}, d.col(kShear));
}

// Derivatives by theta_1 or slip: of the arc (relative), of theta, of the depth and of the shear displacement
// j.
struct StateMotion {
  double weight, theta, depth, j;
};

void addStateMotion(const Contact& c, const Normal& n, const Point& p, const StateMotion& m,
                    Eigen::Ref<Eigen::Vector3d> column) {
  const double sigma = c.soil.sinkage_exponent * n.sigma / n.depth * m.depth;
  const double tau =
      c.tan_friction * (1.0 - p.left) * sigma + p.strength * p.left / c.soil.shear_modulus_m * m.j;
  addMotion(p, n.sigma, {.weight = m.weight, .theta = m.theta, .sigma = sigma, .tau = tau}, column);
}

void addStateMotions(const Contact& c, const Normal& n, const Point& p, double peak_share,
                     ContactDerivative& d) {
  const double travel = 1.0 - c.slip;
  const double by_entry = p.theta / c.theta_1;
  const double sin_n = std::sin(n.theta);
  addStateMotion(c, n, p,
                 {.weight = 1.0 / c.theta_1,
                  .theta = by_entry,
                  .depth = c.radius * (c.sin_1 - sin_n * n.theta / c.theta_1),
                  .j = c.radius * (1.0 - by_entry - travel * (c.cos_1 - p.cosine * by_entry))},
                 d.col(kSinkage));
  const double by_slip = c.soil.c2 * c.theta_1 * n.s;
  addStateMotion(c, n, p,
                 {.weight = peak_share,
                  .theta = by_slip,
                  .depth = -c.radius * sin_n * by_slip,
                  .j = c.radius * (travel * p.cosine * by_slip - by_slip + c.sin_1 - p.sine)},
                 d.col(kSlip));
}

template <class Visit>
void eachPoint(const Contact& c, Visit&& visit) {
  for (std::size_t k = 0; k < kRule.node.size(); ++k) {
    const double t = kRule.node[k];
    const double ds = 3.0 * t * t * kRule.weight[k] * c.theta_1;
    const Normal n(c, t * t * t);
    visit(n, Point(c, n, n.theta, (1.0 - c.peak) * ds), -c.soil.c2 / (1.0 - c.peak));
    visit(n, Point(c, n, c.peak * c.theta_1 * n.s, c.peak * ds), c.soil.c2 / c.peak);
  }
}

ForceVector scale(const Wheel& wheel) {
  const double area = wheel.radius_m * wheel.width_m;
  return {area, area * wheel.radius_m, area};
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
  ForceVector sum = ForceVector::Zero();
  eachPoint(Contact(soil, wheel, state),
            [&](const Normal& n, const Point& p, double) { sum += p.weight * p.forces(n.sigma); });
  return sum.cwiseProduct(scale(wheel));
}

ForceVector contactForces(const ContactSoil& soil, const Wheel& wheel, const ContactState& state,
                          ContactDerivative& derivative) {
  const Contact c(soil, wheel, state);
  ForceVector sum = ForceVector::Zero();
  derivative.setZero();
  eachPoint(c, [&](const Normal& n, const Point& p, double peak_share) {
    sum += p.weight * p.forces(n.sigma);
    addSoilMotions(c, n, p, derivative);
    addStateMotions(c, n, p, peak_share, derivative);
  });
  derivative.col(kSinkage) /= wheel.radius_m * c.sin_1;  // d/d theta_1 to d/dz: dz = r sin theta_1 d theta_1
  derivative = scale(wheel).asDiagonal() * derivative;
  return sum.cwiseProduct(scale(wheel));
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
