#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <optional>

#include <talus/terramech/contact/shear_displacement.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

/// Integration of stresses along a rigid rim for any contact law, and the entry angle at which the rim
/// carries a given load. wong_reece.hpp has the law of the literature, wheel_contact.hpp the law with
/// additional effects. Angles are measured from the downward vertical through the axle, positive in the
/// direction of travel.
namespace talus::terramech {

/// Stress law of a soil under a wheel at a given slip, as rimForces() requires it.
template <class Law>
concept ContactLaw = requires(const Law& law, double x) {
  /// Normal stress [Pa] in front of the stress peak, at a depth [m] below the undisturbed surface.
  { law.pressure_Pa(x) } -> std::convertible_to<double>;
  /// Shear stress [Pa] at normal stress [Pa] and shear displacement [m]; same sign as the displacement.
  { law.shear_Pa(x, x) } -> std::convertible_to<double>;
  /// Angle theta_m [rad] of the normal stress peak at entry angle theta_1 [rad].
  { law.peak_rad(x) } -> std::convertible_to<double>;
  /// Exit angle theta_2 [rad] at entry angle theta_1 [rad]; negative behind the axle.
  { law.exit_rad(x) } -> std::convertible_to<double>;
};

/// Forces of the soil on a rim in contact from theta_1 to theta_2.
struct RimForces {
  double load_N = 0.0;          ///< upward
  double torque_Nm = 0.0;       ///< drive torque about the axle; negative when braking
  double drawbar_pull_N = 0.0;  ///< forward
  double side_force_N = 0.0;  ///< across the wheel plane, negative for slip_angle_rad > 0; 0 at slip angle 0
};

/// Gauss-Legendre rule in t with s = t^Power, where s is the fraction of the arc from an end of contact to
/// the stress peak. The power makes sigma ~ s^n smooth at the end of contact.
template <std::size_t N, int Power>
struct RimQuadrature {
  static constexpr auto kPoints = gaussLegendre<N>();
  static constexpr double s(double t) { return Power == 3 ? t * t * t : t * t; }
  static constexpr double slope(double t) { return Power == 3 ? 3.0 * t * t : 2.0 * t; }
  static double inverse(double s) { return Power == 3 ? std::cbrt(s) : std::sqrt(s); }
  static_assert(Power == 2 || Power == 3);
};
using FineRimRule = RimQuadrature<24, 3>;  ///< relative error <= 1e-9 for any n in use
/// Relative error 1e-6 for driven wheels; for fits, which need millions of contact solutions.
using QuickRimRule = RimQuadrature<8, 2>;
using BrakedRimRule = RimQuadrature<20, 2>;  ///< relative error 1e-6 for slip >= -0.9

namespace detail {

inline double along(double tangent) {
  return tangent;
}
inline double along(const Tangent& tangent) {
  return tangent.along;
}

/// Break points in s, in [0, 1], of the integral: both ends and the sign change of the shear displacement.
struct Breaks {
  std::array<double, 3> s{0.0, 1.0, 1.0};
  int count = 2;
};

/// End angles of the two halves of the contact. The integral is split at the sign change of the displacement
/// along the wheel plane, because there the resultant displacement turns quickly at a small slip angle.
struct Halves {
  double entry_rad, peak_rad, exit_rad;
};

Breaks breaksAt(double sign_change_rad, const Halves& halves);

/// Adds the forces at a point of the front half and at the mirror point of the rear half; both have the same
/// sigma (C.3).
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

  /// Adds both points at fraction s of the arc from the ends of contact (s = 0) to the peak (s = 1).
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

/// Returns the forces on the rim at a given entry angle theta_1 (thesis Eqs. C.8 to C.10, rear half mirrored
/// as in C.3):
///   W  = r b     int_theta_2^theta_1 (sigma cos theta + tau sin theta) d theta
///   T  = r_s r b int tau d theta
///   DP = r b     int (tau cos theta - sigma sin theta) d theta
///   F  = -r b    int tau_y d theta
/// r_s is the radius of the displacement: r, or a larger shear radius for a wheel with lugs. Each half is
/// integrated from the end of contact to the peak and split at the sign change of the shear displacement.
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

/// Entry angle and forces of a rim that carries a given load.
struct RimEquilibrium {
  double entry_angle_rad = 0.0;
  RimForces forces;
  double growth = 0.0;  ///< d log W / d log theta_1 at the last step of the search [-]
};

/// Load and slip to solve for, and settings of the search.
struct RimLoad {
  double load_N = 0.0;       ///< > 0
  double slip = 0.0;         ///< [-1, 1], defined in shear_displacement.hpp
  double first_guess = 0.1;  ///< initial entry angle [rad]
  double growth = 3.0;       ///< initial d log W / d log theta_1 [-]
  double tolerance = 1e-13;  ///< tolerance of log W at which the search ends [-]
};

namespace detail {

/// Root search for the entry angle. The load is almost a power of the entry angle, so the secant method runs
/// on logarithms, inside a bracket that rejects overlong steps. Typical cost: 4 to 6 evaluations.
class EntrySearch {
 public:
  enum class Status { Searching, Found, Sunk };  ///< Sunk: the load exceeds the force at entry angle pi/2

  explicit EntrySearch(const RimLoad& wanted);

  /// Next trial entry angle [rad], in (0, pi/2].
  double entry_rad() const { return entry_; }

  /// Receives the load [N] computed at entry_rad(). While the status is Searching, entry_rad() is the next
  /// trial angle.
  Status take(double load_N);

  /// d log W / d log theta_1 between the last two trials; the initial value before two trials.
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

/// Returns the smallest entry angle in (0, pi/2] at which the rim carries the load; empty if the load is not
/// carried at pi/2. `displacement_at(entry_rad)` returns the shear displacement for an entry angle.
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

/// Returns the equilibrium of a wheel at slip angle 0. Throws std::domain_error if the load is not carried at
/// entry angle pi/2.
template <ContactLaw Law>
RimEquilibrium rimEquilibrium(const Law& law, const Wheel& wheel, const RimLoad& wanted) {
  const auto found = findEquilibrium<FineRimRule>(law, wheel, wanted, [&](double entry) {
    return ShearDisplacement{{wheel.radius_m, wanted.slip, entry}};
  });
  if (!found) detail::throwSunk(wanted.load_N);
  return *found;
}

}  // namespace talus::terramech
