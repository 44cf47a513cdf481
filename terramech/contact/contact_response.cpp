#include <array>
#include <cmath>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
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

}  // namespace talus::terramech
