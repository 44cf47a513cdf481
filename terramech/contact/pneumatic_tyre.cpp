#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/pneumatic_tyre.hpp>
#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

namespace talus::terramech {

double bekkerPressure_Pa(const Soil& soil, double width_m, double depth_m) {
  return sinkageModulus(soil, width_m) * std::pow(depth_m, soil.sinkage_exponent);
}

double bekkerDepth_m(const Soil& soil, double width_m, double pressure_Pa) {
  const double modulus = sinkageModulus(soil, width_m);
  if (!(modulus > 0.0))
    throw std::domain_error("a soil with modulus " + std::to_string(modulus) + " carries nothing");
  RangeCheck{"pressure-sinkage"}.atLeast("pressure_Pa", pressure_Pa, 0.0);
  return std::pow(pressure_Pa / modulus, 1.0 / soil.sinkage_exponent);
}

namespace {

constexpr auto kTyreRule = gaussLegendre<24>();

void check(const Tyre& tyre, const TyreOperation& operation) {
  validate(tyre.wheel);
  const RangeCheck range{"tyre"};
  range.atLeast("inflation_Pa", tyre.inflation_Pa, 0.0);
  range.atLeast("carcass_Pa", tyre.carcass_Pa, 0.0);
  range.above("inflation_Pa + carcass_Pa", tyre.inflation_Pa + tyre.carcass_Pa, 0.0);
  range.atLeast("hysteresis", tyre.hysteresis, 0.0);
  range.atLeast("friction", tyre.friction, 0.0);
  range.above("tread_stiffness", tyre.tread_stiffness, 0.0);
  range.above("load_N", operation.load_N, 0.0);
  range.within("slip", operation.slip, {0.0, 1.0});
}

double pressureOf(const Tyre& tyre) {
  return tyre.inflation_Pa + tyre.carcass_Pa;
}

/// Integral of f from a to b by Gauss-Legendre quadrature.
template <class Function>
double integral(double a, double b, const Function& f) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kTyreRule.node.size(); ++k)
    sum += kTyreRule.weight[k] * f(a + (b - a) * kTyreRule.node[k]);
  return sum * (b - a);
}

/// Tyre with a flat of flat_length_m at depth z_0, and a circular arc in front of the flat up to the surface.
class FlattenedTyre {
 public:
  FlattenedTyre(const Tyre& tyre, const Soil& soil, double slip, double deflection_m)
      : tyre_(tyre),
        soil_(soil),
        r_(tyre.wheel.radius_m),
        slip_(slip),
        deflection_m_(deflection_m),
        z0_(bekkerDepth_m(soil, tyre.wheel.width_m, pressureOf(tyre))),
        flat_end_(2.0 * std::asin(std::sqrt(0.5 * deflection_m / r_))),
        entry_(2.0 * std::asin(std::sqrt(std::min(1.0, 0.5 * (deflection_m + z0_) / r_)))),
        displacement_({r_, slip, entry_}) {}

  double flatLength_m() const { return 2.0 * r_ * std::sin(flat_end_); }
  double sinkage_m() const { return z0_; }

  double load_N() const {
    const double round =
        r_ * front([&](double a, double s, double t) { return s * std::cos(a) + t * std::sin(a); });
    return tyre_.wheel.width_m * (pressureOf(tyre_) * flatLength_m() + round);
  }

  double drawbarPull_N() const {
    const double round =
        r_ * front([&](double a, double s, double t) { return t * std::cos(a) - s * std::sin(a); });
    return tyre_.wheel.width_m * (flatShear_N_m() + round);
  }

  double torque_Nm() const {
    const double round = r_ * r_ * front([](double, double, double t) { return t; });
    return tyre_.wheel.width_m * ((r_ - deflection_m_) * flatShear_N_m() + round);
  }

 private:
  /// Integral over the arc in front of the flat. The substitution s = t^3 from the entry smooths sigma ~
  /// depth^n.
  template <class Density>
  double front(const Density& density) const {
    return integral(0.0, 1.0, [&](double t) {
      const double angle = entry_ - (entry_ - flat_end_) * t * t * t;
      const double depth = 2.0 * r_ * std::sin(0.5 * (entry_ + angle)) * std::sin(0.5 * (entry_ - angle));
      const double sigma = bekkerPressure_Pa(soil_, tyre_.wheel.width_m, depth);
      const double tau = janosiHanamoto_Pa(soil_, sigma, displacement_.at_m(angle));
      return density(angle, sigma, tau) * (entry_ - flat_end_) * 3.0 * t * t;
    });
  }

  double flatShear_N_m() const {
    const double start = displacement_.at_m(flat_end_);
    return integral(0.0, flatLength_m(),
                    [&](double x) { return janosiHanamoto_Pa(soil_, pressureOf(tyre_), start + slip_ * x); });
  }

  const Tyre& tyre_;
  const Soil& soil_;
  double r_, slip_, deflection_m_, z0_, flat_end_, entry_;
  ShearDisplacement displacement_;
};

/// Returns the smallest deflection [m] at which the tyre carries the load, by bisection. Flat length and
/// carried load increase with deflection. Throws std::domain_error when the load exceeds that of the largest
/// deflection.
double carryingDeflection_m(const Tyre& tyre, const Soil& soil, const TyreOperation& operation) {
  const double depth = bekkerDepth_m(soil, tyre.wheel.width_m, pressureOf(tyre));
  double low = 0.0, high = tyre.wheel.radius_m - depth;  // high: the axle is at the surface
  const auto carries = [&](double deflection) {
    return FlattenedTyre{tyre, soil, operation.slip, deflection}.load_N() >= operation.load_N;
  };
  if (high <= 0.0 || !carries(high)) throw std::domain_error("the tyre sinks and flattens to its axle");
  if (carries(low)) return low;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (carries(middle) ? high : low) = middle;
  }
  return high;
}

TyreForces roundTyre(const Tyre& tyre, const Soil& soil, const TyreOperation& operation) {
  const WheelForces wheel =
      equilibrium(soil, tyre.wheel, {.load_N = operation.load_N, .slip = operation.slip});
  return {.mode = TyreMode::Rigid,
          .sinkage_m = wheel.sinkage_m,
          .torque_Nm = wheel.torque_Nm,
          .drawbar_pull_N = wheel.drawbar_pull_N};
}

TyreForces flatTyre(const Tyre& tyre, const Soil& soil, const TyreOperation& operation) {
  const double deflection = carryingDeflection_m(tyre, soil, operation);
  const FlattenedTyre flat{tyre, soil, operation.slip, deflection};
  const double flexing_N = tyre.hysteresis * operation.load_N;
  return {.mode = TyreMode::Flattened,
          .sinkage_m = flat.sinkage_m(),
          .deflection_m = deflection,
          .flat_length_m = flat.flatLength_m(),
          .torque_Nm = flat.torque_Nm() + flexing_N * tyre.wheel.radius_m,
          .drawbar_pull_N = flat.drawbarPull_N()};
}

}  // namespace

double criticalPressure_Pa(const Soil& soil, const Wheel& wheel, double load_N) {
  const double n = soil.sinkage_exponent;
  if (n >= 3.0) throw std::domain_error("the critical pressure is known for n < 3 only");
  const double power = 1.0 / (2.0 * n + 1.0);
  const double line = 3.0 * load_N / ((3.0 - n) * wheel.width_m * std::sqrt(2.0 * wheel.radius_m));
  return std::pow(sinkageModulus(soil, wheel.width_m), power) * std::pow(line, 2.0 * n * power);
}

TyreForces tyreOnRigidGround(const Tyre& tyre, const TyreOperation& operation) {
  check(tyre, operation);
  const double r = tyre.wheel.radius_m, p = pressureOf(tyre),
               length = operation.load_N / (p * tyre.wheel.width_m);
  if (length >= 2.0 * r) throw std::domain_error("the tyre flattens over its whole diameter");
  const double deflection = r - std::sqrt(r * r - 0.25 * length * length);
  // Brush model: the shear stress increases at rate stiffness x slip per metre, up to mu p at x_full.
  const double rate = tyre.tread_stiffness * operation.slip, strength = tyre.friction * p;
  const double x_full = rate > 0.0 ? std::min(length, strength / rate) : length;
  const double shear_N = tyre.wheel.width_m * (0.5 * rate * x_full * x_full + strength * (length - x_full));
  const double flexing_N = tyre.hysteresis * operation.load_N;
  return {.mode = TyreMode::Flattened,
          .deflection_m = deflection,
          .flat_length_m = length,
          .torque_Nm = shear_N * (r - deflection) + flexing_N * r,
          .drawbar_pull_N = shear_N};
}

TyreForces tyreOnSoftGround(const Tyre& tyre, const Soil& soil, const TyreOperation& operation) {
  check(tyre, operation);
  validate(soil);
  const double critical = criticalPressure_Pa(soil, tyre.wheel, operation.load_N);
  TyreForces forces =
      pressureOf(tyre) >= critical ? roundTyre(tyre, soil, operation) : flatTyre(tyre, soil, operation);
  forces.critical_pressure_Pa = critical;
  return forces;
}

RigidGroundForces rigidGroundForces(const Wheel& wheel, const GroundFriction& friction, double load_N,
                                    double torque_Nm) {
  validate(wheel);
  const RangeCheck check{"wheel on rigid ground"};
  check.above("load_N", load_N, 0.0);
  check.finite("torque_Nm", torque_Nm);
  check.atLeast("kinetic_coefficient", friction.kinetic_coefficient, 0.0);
  check.atLeast("static_coefficient", friction.static_coefficient, friction.kinetic_coefficient);
  const double thrust_N = torque_Nm / wheel.radius_m;
  if (std::abs(thrust_N) <= friction.static_coefficient * load_N) return {thrust_N, false};
  return {std::copysign(friction.kinetic_coefficient * load_N, torque_Nm), true};
}

}  // namespace talus::terramech
