#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

namespace talus::terramech {

/// Integrals of a triangular stress over the contact arc of a wheel, weighted with the cosine and sine of the
/// rim angle theta. The stress peak is at half the entry angle, theta_m = h = theta_1/2 (thesis Eqs. B.2,
/// 2.1). Every integral is dimensionless.
///
/// A stress with peak value 1 that rises linearly on [0, h] and falls linearly on [h, theta_1] has the
/// integrals
///     integral of cos = P/h,  P = 2 cos h - cos 2h - 1 = 4 cos h sin^2(h/2)
///     integral of sin = Q/h,  Q = 2 sin h - sin 2h     = 4 sin h sin^2(h/2)
/// The shear offset at the bottom of the wheel, 1 - theta/h on [0, h], has the integrals
///     integral of cos = (1 - cos h)/h,  integral of sin = 1 - sin(h)/h
/// Thesis Eq. 2.3 prints another term for this offset; the integrals here are the corrected ones. The product
/// forms of P and Q do not cancel at small h.
struct LinearStressMoments {
  explicit LinearStressMoments(double entry_angle_rad);

  double half_angle_rad;  ///< h = theta_1/2 [rad]
  double peak_cos;        ///< P/h
  double peak_sin;        ///< Q/h
  double offset_cos;      ///< (1 - cos h)/h
  double offset_sin;      ///< 1 - sin(h)/h
};

/// Fraction of the shear strength that is mobilised at two angles of the rim (thesis Eq. 2.7) [-]. Each
/// fraction is in [0, 1) for a driven wheel.
struct Mobilisation {
  double peak;    ///< A, at the stress peak theta_m = theta_1/2
  double bottom;  ///< B, at the bottom of the wheel, theta = 0
};

/// Returns the mobilised fractions A and B of thesis Eq. 2.7 for one telemetry sample and a shear deformation
/// modulus K = shear_modulus_m. Throws std::invalid_argument unless K > 0 and 0 <= sinkage_m < 2 r.
Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Returns the shear displacement j [m] of the soil at the stress peak theta_m = theta_1/2 (thesis Eq. C.6).
double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample);

/// Shear strength and shear stress of a soil under a plate or a wheel rim.

/// Returns the Mohr-Coulomb strength tau_max = c + sigma tan phi [Pa] (thesis Eq. A.2) at the normal stress
/// sigma = normal_Pa >= 0.
double shearStrength_Pa(const Soil& soil, double normal_Pa);

/// Returns the shear stress of Janosi and Hanamoto, tau = tau_max (1 - e^{-|j|/K}) [Pa] (thesis Eq. A.4;
/// janosi_hanamoto_1961), with the sign of the shear displacement j = displacement_m.
double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m);

/// Returns the shear stress of the idealised elasto-plastic law, tau = tau_max min(|j|/K, 1) [Pa], with the
/// sign of the shear displacement j = displacement_m. The law is thesis Eq. A.3, where j is named strain.
double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m);

/// Bulldozing resistance of the soil against the side face of a wheel that slides sideways.

/// Resistance of the soil to a vertical blade at the depth h below the surface, per width of the blade [N/m]:
///   R = D1 (c h + D2 gamma h^2 / 2),  D1 = cot X + tan(X + phi),  D2 = cot X + cot^2 X tan phi,
///   X = 45 deg - phi/2
/// (hegedus_1960 for a vertical blade, used by ishigami_2007 for wheels). c, phi and gamma are cohesion,
/// friction angle and unit weight of the soil.
struct Hegedus {
  double per_depth_Pa = 0.0;            ///< coefficient D1 c of h
  double per_depth_squared_N_m3 = 0.0;  ///< coefficient D1 D2 gamma / 2 of h^2

  /// Returns R [N/m] at the blade depth h = depth_m.
  double resistance_N_m(double depth_m) const {
    return depth_m * (per_depth_Pa + depth_m * per_depth_squared_N_m3);
  }
};

/// Strength and unit weight of the soil that the blade pushes aside, in the local gravity.
struct PushedSoil {
  double cohesion_Pa = 0.0;   ///< cohesion c >= 0
  double tan_friction = 0.0;  ///< tangent of the friction angle, tan phi >= 0 [-]
  double weight_N_m3 = 0.0;   ///< unit weight gamma = density times gravity, >= 0
};

/// Returns the coefficients of the blade resistance in a soil.
Hegedus hegedus(const PushedSoil& soil);

/// Part of the side face of a wheel that is below the soil surface.
struct WheelFace {
  double radius_m = 0.1;         ///< wheel radius r > 0
  double entry_angle_rad = 0.0;  ///< entry angle theta_1 in [0, pi/2]
};

/// Returns the resistance of the soil to the side face of a wheel [N]: the integral of the blade resistance
/// R(h) over the chord of the face, int R(h) dx with x = r sin theta, h = r (cos theta - cos theta_1) and
/// theta from -theta_1 to theta_1. Both halves of the face push undisturbed soil, independent of the exit
/// angle of the contact (ours; ishigami_2007 integrates only over the contact of the rim). The closed form is
///   D1 [c r^2 (theta_1 - S C) + D2 gamma r^3 (S - S^3/3 - theta_1 C)],  S, C = sin, cos theta_1.
double faceResistance_N(const Hegedus& soil, const WheelFace& face);

/// Returns the entry angle theta_1 = arccos(1 - z/r) [rad], in [0, pi), of a wheel of radius r at the sinkage
/// z = sinkage_m. The entry angle is the angle between the downward vertical and the front end of the
/// contact. The formula is evaluated as 2 arcsin(sqrt(z / 2r)), which does not cancel at small z. Throws
/// std::invalid_argument unless radius_m > 0 and 0 <= sinkage_m < 2 r.
double entryAngle_rad(const Wheel& wheel, double sinkage_m);

/// Returns the sinkage z = r (1 - cos theta_1) [m] of a wheel at the entry angle theta_1 [rad]. This function
/// is the inverse of entryAngle_rad().
double sinkage_m(const Wheel& wheel, double entry_angle_rad);

/// Returns the length 2 sqrt(2 r z - z^2) [m] of the chord at which the soil surface cuts a wheel of sinkage
/// z that is spun in place (thesis Eq. B.1). Throws the exceptions of entryAngle_rad().
double contactChord_m(const Wheel& wheel, double sinkage_m);

/// Returns the travel ratio v / (r omega) [-] of travel speed to rim speed at a slip in [-1, 1]. The slip is
/// the driven slip or the negative skid of wong_2001:
///   driven (slip >= 0): slip = 1 - v/(r omega), ratio 1 - slip; 0 for a wheel that spins in place;
///   braked (slip < 0):  slip = r omega/v - 1,   ratio 1/(1 + slip); infinite for a locked wheel.
/// Both definitions agree at slip 0.
inline double travelRatio(double slip) {
  if (slip >= 0.0) return 1.0 - slip;
  return slip > -1.0 ? 1.0 / (1.0 + slip) : std::numeric_limits<double>::infinity();
}

/// Largest slip angle in use [rad], 89.94 deg; larger angles are clamped. At 90 deg the travel along the
/// wheel plane is 0 and tan(beta) is infinite, while their product, the travel across the wheel plane, is
/// finite and shears the soil.
inline constexpr double kSteepestSlipAngle_rad = 1.5698;

/// Returns the sliding speed of the rim over the ground divided by the greater of rim speed and travel speed
/// [-]:
/// s_R = |(r omega - v cos beta, v sin beta)| / max(r omega, v)
/// `slip` in [-1, 1] is the slip i along the wheel plane, and beta = slip_angle_rad. s_R is |i| at beta = 0,
/// 1 for a locked wheel, and sqrt 2 for r omega = v at beta = 90 deg. The definition is ours; ding_2010 uses
/// only the component along the wheel plane.
double resultantSlip(double slip, double slip_angle_rad);

/// Shear stress or shear displacement of the soil under a wheel with a slip angle, as components.
struct Tangent {
  double along = 0.0;  ///< along the wheel plane
  /// Across the wheel plane, positive in the direction in which the wheel moves sideways.
  double across = 0.0;
};

/// Returns the components of a shear stress of magnitude `size` in the direction of `displacement`, as in an
/// isotropic soil (friction circle). `path` is the length of `displacement`.
inline Tangent alongDisplacement(double size, const Tangent& displacement, double path) {
  const double unit = size / (path + 1e-300);
  return {unit * displacement.along, unit * displacement.across};
}

/// Shear displacement j of the soil along the rim of a wheel at slip angle 0:
/// j(theta) = r [(theta_1 - theta) - q (sin theta_1 - sin theta)]
/// (thesis Eq. C.6, with the travel ratio q = travelRatio() in place of 1 - i, for braked wheels). j is the
/// path of a rim point over the soil since the point entered the soil at theta_1. j is positive if the rim
/// drags the soil backwards.
class ShearDisplacement {
 public:
  /// Radius, slip and entry angle of the wheel.
  struct Parameters {
    double radius_m;         ///< radius r of the shear displacement, > 0
    double slip;             ///< slip, [-1, 1]
    double entry_angle_rad;  ///< theta_1 in (0, pi/2]
  };

  explicit ShearDisplacement(const Parameters& p)
      : p_(p), travel_(travelRatio(p.slip)), sin_entry_(std::sin(p.entry_angle_rad)) {}

  double radius_m() const { return p_.radius_m; }
  double entryAngle_rad() const { return p_.entry_angle_rad; }

  /// Returns j [m] at a rim angle theta < theta_1; minus infinity for a locked wheel.
  double at_m(double theta_rad) const {
    return p_.radius_m * ((p_.entry_angle_rad - theta_rad) - travel_ * (sin_entry_ - std::sin(theta_rad)));
  }

  /// Returns the rim angle in (lowest_rad, theta_1) at which j changes sign, or NaN if j does not change
  /// sign. A sign change occurs only for braked or towed wheels: their rim shears the soil backwards at the
  /// entry and forwards farther below.
  double signChange_rad(double lowest_rad) const;

 private:
  Parameters p_;
  double travel_;
  double sin_entry_;
};

/// Shear displacement of the soil along the rim of a wheel at slip angle beta. The component along the wheel
/// plane is that of ShearDisplacement. The component across the wheel plane is j_y = r q tan(beta) (theta_1 -
/// theta) (ishigami_2007).
class SideSlipDisplacement {
 public:
  /// Radii, slip, slip angle and entry angle of the wheel.
  struct Parameters {
    double shear_radius_m;   ///< radius for the component along the wheel plane, > 0
    double radius_m;         ///< radius of the rim, > 0
    double slip;             ///< slip, [-1, 1]
    double slip_angle_rad;   ///< slip angle beta, [-pi/2, pi/2], clamped to kSteepestSlipAngle_rad
    double entry_angle_rad;  ///< theta_1
  };

  explicit SideSlipDisplacement(const Parameters& p);

  double radius_m() const { return p_.shear_radius_m; }
  double entryAngle_rad() const { return p_.entry_angle_rad; }
  /// Returns the rim angle in (lowest_rad, theta_1) at which the component along the wheel plane changes
  /// sign, or NaN if this component does not change sign.
  double signChange_rad(double lowest_rad) const;
  /// Returns both components of the shear displacement [m] at a rim angle theta < theta_1.
  Tangent at_m(double theta_rad) const {
    const double arc = p_.entry_angle_rad - theta_rad;
    return {p_.shear_radius_m * (arc - travel_ * (sin_entry_ - std::sin(theta_rad))), lateral_m_ * arc};
  }

 private:
  Parameters p_;
  double travel_, lateral_m_, sin_entry_;
};

/// Integration of the soil stresses along a rigid wheel rim for any stress law, and search for the entry
/// angle at which the rim carries a given load. The stress law of Wong and Reece is in wheel_on_soil.hpp, the
/// law with additional effects in refined_model.hpp. A rim angle theta is measured from the downward vertical
/// through the axle and is positive in the direction of travel.

/// Requirements of rimForces() on the stress law of a soil under a wheel at a given slip.
template <class Law>
concept ContactLaw = requires(const Law& law, double x) {
  /// Normal stress sigma [Pa] in front of the stress peak, at a depth [m] below the undisturbed surface.
  { law.pressure_Pa(x) } -> std::convertible_to<double>;
  /// Shear stress tau [Pa] at a normal stress [Pa] and a shear displacement [m]; tau has the sign of the
  /// displacement.
  { law.shear_Pa(x, x) } -> std::convertible_to<double>;
  /// Rim angle theta_m [rad] of the peak of the normal stress, at entry angle theta_1 [rad].
  { law.peak_rad(x) } -> std::convertible_to<double>;
  /// Exit angle theta_2 [rad] at entry angle theta_1 [rad]; theta_2 is negative behind the axle.
  { law.exit_rad(x) } -> std::convertible_to<double>;
};

/// Forces of the soil on a rim that is in contact from theta_1 to theta_2.
struct RimForces {
  double load_N = 0.0;          ///< vertical force, positive upward
  double torque_Nm = 0.0;       ///< drive torque about the axle; negative when braking
  double drawbar_pull_N = 0.0;  ///< force along the wheel plane, positive forward
  /// Force across the wheel plane: negative for slip_angle_rad > 0, 0 at slip angle 0.
  double side_force_N = 0.0;
};

/// Gauss-Legendre rule in t with s = t^Power, where s is the fraction of the arc from one end of the contact
/// (s = 0) to the stress peak (s = 1). The substitution makes the stress sigma ~ s^n a smooth function at the
/// end of contact.
template <std::size_t N, int Power>
struct RimQuadrature {
  static constexpr auto kPoints = gaussLegendre<N>();
  static constexpr double s(double t) { return Power == 3 ? t * t * t : t * t; }
  static constexpr double slope(double t) { return Power == 3 ? 3.0 * t * t : 2.0 * t; }
  static double inverse(double s) { return Power == 3 ? std::cbrt(s) : std::sqrt(s); }
  static_assert(Power == 2 || Power == 3);
};
using FineRimRule = RimQuadrature<24, 3>;  ///< relative error <= 1e-9 for any sinkage exponent n in use
/// Rule for parameter fits, which need millions of contact solutions: relative error 1e-6 for driven wheels.
using QuickRimRule = RimQuadrature<8, 2>;
using BrakedRimRule = RimQuadrature<20, 2>;  ///< relative error 1e-6 for slip >= -0.9

namespace detail {

/// Returns the component along the wheel plane of a shear stress.
inline double along(double tangent) {
  return tangent;
}
inline double along(const Tangent& tangent) {
  return tangent.along;
}

/// Break points of the integral over one half of the contact, as fractions s in [0, 1]: both ends, and the
/// point at which the shear displacement changes sign, if there is one.
struct Breaks {
  std::array<double, 3> s{0.0, 1.0, 1.0};
  int count = 2;
};

/// Angles that bound the two halves of the contact: front half from theta_1 to theta_m, rear half from
/// theta_m to theta_2. The integral is split where the displacement along the wheel plane changes sign,
/// because at a small slip angle the direction of the resultant displacement turns quickly there.
struct Halves {
  double entry_rad, peak_rad, exit_rad;
};

Breaks breaksAt(double sign_change_rad, const Halves& halves);

/// Integrand of rimForces(). Each evaluation adds the forces at a point of the front half and at the point of
/// the rear half with the same fraction s; both points have the same normal stress sigma (thesis Eq. C.3).
template <class Law, class Displacement>
class RimIntegrand {
 public:
  RimIntegrand(const Law& law, const Displacement& displacement, double radius_m)
      : law_(law),
        displacement_(displacement),
        radius_m_(radius_m),
        entry_(displacement.entryAngle_rad()),
        peak_(law.peak_rad(entry_)),
        exit_(law.exit_rad(entry_)) {}

  double peak_rad() const { return peak_; }
  double exit_rad() const { return exit_; }

  /// Adds the forces at both points of fraction s, times the interval ds, to `sum`.
  void add(double s, double ds, RimForces& sum) const {
    const double front = entry_ - (entry_ - peak_) * s;
    const double rear = exit_ + (peak_ - exit_) * s;
    // r (cos theta - cos theta_1) without cancellation.
    const double depth_m =
        2.0 * radius_m_ * std::sin(0.5 * (entry_ + front)) * std::sin(0.5 * (entry_ - front));
    const double sigma = law_.pressure_Pa(depth_m);
    addPoint(front, sigma, (entry_ - peak_) * ds, sum);
    addPoint(rear, sigma, (peak_ - exit_) * ds, sum);
  }

 private:
  void addPoint(double theta, double sigma, double d_theta, RimForces& sum) const {
    const auto shear = law_.shear_Pa(sigma, displacement_.at_m(theta));
    const double tau = along(shear), c = std::cos(theta), s = std::sin(theta);
    sum.load_N += (sigma * c + tau * s) * d_theta;
    sum.torque_Nm += tau * d_theta;
    sum.drawbar_pull_N += (tau * c - sigma * s) * d_theta;
    if constexpr (std::same_as<decltype(shear), const Tangent>) sum.side_force_N -= shear.across * d_theta;
  }

  const Law& law_;
  const Displacement& displacement_;
  double radius_m_, entry_, peak_, exit_;
};

}  // namespace detail

/// Returns the forces on the rim of a wheel of radius r and width b at the entry angle theta_1 of
/// `displacement` (thesis Eqs. C.8 to C.10; the normal stress of the rear half mirrors that of the front
/// half, Eq. C.3):
///   W  = r b     int_theta_2^theta_1 (sigma cos theta + tau sin theta) d theta
///   T  = r_s r b int tau d theta
///   DP = r b     int (tau cos theta - sigma sin theta) d theta
///   F  = -r b    int tau_y d theta
/// r_s is the radius of the shear displacement: r, or a larger radius for a wheel with lugs. tau_y is the
/// component of the shear stress across the wheel plane. Each half of the contact is integrated from its end
/// to the stress peak and is split where the shear displacement changes sign.
template <class Rule = FineRimRule, class Law, class Displacement>
RimForces rimForces(const Law& law, const Wheel& wheel, const Displacement& displacement) {
  const detail::RimIntegrand integrand{law, displacement, wheel.radius_m};
  const auto breaks =
      detail::breaksAt(displacement.signChange_rad(integrand.exit_rad()),
                       {displacement.entryAngle_rad(), integrand.peak_rad(), integrand.exit_rad()});
  RimForces sum;
  for (int piece = 0; piece + 1 < breaks.count; ++piece) {
    const double start = Rule::inverse(breaks.s[static_cast<std::size_t>(piece)]);
    const double length = Rule::inverse(breaks.s[static_cast<std::size_t>(piece) + 1]) - start;
    for (std::size_t k = 0; k < Rule::kPoints.node.size(); ++k) {
      const double t = start + length * Rule::kPoints.node[k];
      integrand.add(Rule::s(t), Rule::slope(t) * length * Rule::kPoints.weight[k], sum);
    }
  }
  const double area = wheel.radius_m * wheel.width_m;
  return {sum.load_N * area, sum.torque_Nm * area * displacement.radius_m(), sum.drawbar_pull_N * area,
          sum.side_force_N * area};
}

/// Entry angle theta_1 at which the rim carries a given load W, with the forces on the rim.
struct RimEquilibrium {
  double entry_angle_rad = 0.0;  ///< theta_1, in (0, pi/2]
  RimForces forces;
  double growth = 0.0;  ///< d log W / d log theta_1 at the last step of the search [-]
};

/// Load and slip of the wheel, and settings of the search for the entry angle.
struct RimLoad {
  double load_N = 0.0;       ///< wanted load W > 0
  double slip = 0.0;         ///< slip in [-1, 1], defined by ShearDisplacement
  double first_guess = 0.1;  ///< first trial entry angle [rad]
  double growth = 3.0;       ///< first estimate of d log W / d log theta_1 [-]
  double tolerance = 1e-13;  ///< error of log W at which the search ends [-]
};

namespace detail {

/// Root search for the entry angle theta_1. The load W is almost a power of theta_1, so the secant method
/// runs on the logarithms of both, inside a bracket that rejects overlong steps. The search typically takes 4
/// to 6 evaluations of the load.
class EntrySearch {
 public:
  /// Sunk: the wanted load exceeds the load carried at entry angle pi/2
  enum class Status { Searching, Found, Sunk };

  explicit EntrySearch(const RimLoad& wanted);

  /// Returns the next trial entry angle [rad], in (0, pi/2].
  double entry_rad() const { return entry_; }

  /// Receives the load [N] that the caller computed at entry_rad() and returns the status. While the status
  /// is Searching, entry_rad() is the next trial angle.
  Status take(double load_N);

  /// Returns d log W / d log theta_1 between the last two trials [-]; before two trials, the first estimate.
  double growth() const { return growth_; }

 private:
  void learnGrowth(double log_ratio);
  double next(double log_ratio) const;

  double wanted_N_, entry_, growth_, tolerance_;
  double low_ = 0.0, high_ = 0.0;  // high 0: no upper bound yet
  double last_log_entry_ = 0.0, last_log_ratio_ = 0.0;
  int trials_ = 0;
};

[[noreturn]] void throwSunk(double load_N);

}  // namespace detail

/// Returns the smallest entry angle in (0, pi/2] at which the rim carries the load of `wanted`, with the
/// forces. Returns nullopt if the rim carries less than this load at pi/2. `displacement_at(entry_rad)`
/// returns the shear displacement of the rim for an entry angle [rad].
template <class Rule, class Law, class DisplacementAt>
std::optional<RimEquilibrium> findEquilibrium(const Law& law, const Wheel& wheel, const RimLoad& wanted,
                                              const DisplacementAt& displacement_at) {
  using Status = detail::EntrySearch::Status;
  detail::EntrySearch search{wanted};
  while (true) {
    const double entry = search.entry_rad();
    const RimForces forces = rimForces<Rule>(law, wheel, displacement_at(entry));
    const Status status = search.take(forces.load_N);
    if (status == Status::Found) return RimEquilibrium{entry, forces, search.growth()};
    if (status == Status::Sunk) return std::nullopt;
  }
}

/// Returns the entry angle and forces of a wheel at slip angle 0 that carries the load of `wanted`. Throws
/// std::domain_error if the rim carries less than this load at entry angle pi/2.
template <ContactLaw Law>
RimEquilibrium rimEquilibrium(const Law& law, const Wheel& wheel, const RimLoad& wanted) {
  const auto found = findEquilibrium<FineRimRule>(law, wheel, wanted, [&](double entry) {
    return ShearDisplacement{{wheel.radius_m, wanted.slip, entry}};
  });
  if (!found) detail::throwSunk(wanted.load_N);
  return *found;
}

}  // namespace talus::terramech
