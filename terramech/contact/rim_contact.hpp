#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <optional>

#include <talus/terramech/contact/shear_displacement.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

/// Forces on a rigid rim from any stress laws, and the entry angle at which they carry a load. wong_reece.hpp
/// is the law of the literature, wheel_contact.hpp the one with the effects that it lacks; both are
/// integrated here. Angles are measured from the downward vertical through the axle, positive towards the
/// direction of travel.
namespace talus::terramech {

/// What the integral needs to know of a soil under a wheel at a given slip.
template <class Law>
concept ContactLaw = requires(const Law& law, double x) {
  /// Normal stress [Pa] in front of the stress peak at a depth below the undisturbed surface [m].
  { law.pressure_Pa(x) } -> std::convertible_to<double>;
  /// Shear stress [Pa], signed as the displacement, at normal stress [Pa] and shear displacement [m].
  { law.shear_Pa(x, x) } -> std::convertible_to<double>;
  /// Angle of the normal stress peak theta_m [rad] at entry angle theta_1 [rad].
  { law.peak_rad(x) } -> std::convertible_to<double>;
  /// Angle where contact ends, theta_2 [rad], at entry angle theta_1 [rad]; negative behind the axle.
  { law.exit_rad(x) } -> std::convertible_to<double>;
};

/// What the soil does to a rim in contact from theta_1 down to theta_2.
struct RimForces {
  double load_N = 0.0;          ///< upward
  double torque_Nm = 0.0;       ///< about the axle that the motor must give; negative when braking
  double drawbar_pull_N = 0.0;  ///< forward
  double side_force_N = 0.0;    ///< against the sideways motion < 0; 0 for a wheel that rolls straight
};

/// Gauss-Legendre in t, s = t^Power being the way from an end of contact to the stress peak: the power makes
/// sigma ~ s^n smooth where contact begins.
template <std::size_t N, int Power>
struct RimRule {
  static constexpr auto kPoints = gaussLegendre<N>();
  static constexpr double s(double t) { return Power == 3 ? t * t * t : t * t; }
  static constexpr double slope(double t) { return Power == 3 ? 3.0 * t * t : 2.0 * t; }
  static double inverse(double s) { return Power == 3 ? std::cbrt(s) : std::sqrt(s); }
  static_assert(Power == 2 || Power == 3);
};
using FineRimRule = RimRule<24, 3>;    ///< relative accuracy 1e-9 or better for any n that occurs
using QuickRimRule = RimRule<8, 2>;    ///< 1e-6 of a driven wheel: fits solve the contact millions of times
using BrakedRimRule = RimRule<20, 2>;  ///< 1e-6 to slip -0.9

namespace detail {

inline double along(double tangent) {
  return tangent;
}
inline double along(const Tangent& tangent) {
  return tangent.along;
}

/// Break points of the integral in s in [0, 1]: its ends and where the shear displacement changes sign.
struct Breaks {
  std::array<double, 3> s{0.0, 1.0, 1.0};
  int count = 2;
};

/// What the integral is split by: the ends of the halves, and where the displacement along the wheel plane
/// changes sign, where a resultant turns quickly at a small slip angle.
struct Halves {
  double entry_rad, peak_rad, exit_rad;
};

Breaks breaksAt(double sign_change_rad, const Halves& halves);

/// Sum of the forces of one point of the front half and its mirror point in the rear half, which share sigma
/// (C.3).
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

  /// Adds both points at fraction s of the way from the ends of contact (s = 0) to the peak (s = 1).
  void add(double s, double ds, RimForces& sum) const {
    const double front = entry_ - (entry_ - peak_) * s;
    const double rear = exit_ + (peak_ - exit_) * s;
    // cos theta - cos theta_1 without cancellation.
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

/// Forces on the rim at a given entry angle theta_1 (thesis C.8 to C.10 with C.3's mirrored rear half):
///   W  = r b     int_theta_2^theta_1 (sigma cos theta + tau sin theta) d theta
///   T  = r_s r b int tau d theta
///   DP = r b     int (tau cos theta - sigma sin theta) d theta
///   F  = -r b    int tau_y d theta
/// r_s is the displacement's radius, r unless lugs shear the soil further out. Each half runs from its end of
/// contact to the peak and is split where the shear displacement changes sign.
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

/// A rim that carries its load.
struct RimEquilibrium {
  double entry_angle_rad = 0.0;
  RimForces forces;
  double growth = 0.0;  ///< d log W / d log theta_1 as the search saw it last [-]
};

/// What to solve for.
struct RimLoad {
  double load_N = 0.0;       ///< > 0
  double slip = 0.0;         ///< [-1, 1], see shear_displacement.hpp
  double first_guess = 0.1;  ///< entry angle to start from [rad]
  double growth = 3.0;       ///< d log W / d log theta_1 to start from [-]
  double tolerance = 1e-13;  ///< of log W at which the search ends [-]
};

namespace detail {

/// Search for the entry angle. The load grows almost as a power of it, so the secant method runs on
/// logarithms, inside a bracket that catches a step too far; four to six trials.
class EntrySearch {
 public:
  enum class Status { Searching, Found, Sunk };  ///< Sunk: not even the axle on the ground carries the load

  explicit EntrySearch(const RimLoad& wanted);

  /// The angle to try next [rad], in (0, pi/2].
  double entry_rad() const { return entry_; }

  /// Takes the load [N] found there; while it searches on, entry_rad() has moved.
  Status take(double load_N);

  /// d log W / d log theta_1 between the last two trials, or as it was given.
  double growth() const { return growth_; }

 private:
  void learnGrowth(double log_ratio);
  double next(double log_ratio) const;

  double wanted_N_, entry_, growth_, tolerance_;
  double low_ = 0.0, high_ = 0.0;  // high 0: not met yet
  double last_log_entry_ = 0.0, last_log_ratio_ = 0.0;
  int trials_ = 0;
};

[[noreturn]] void throwSunk(double load_N);

}  // namespace detail

/// The smallest entry angle in (0, pi/2] at which the rim carries the load; empty when the wheel would sink
/// to its axle before it carried the load. `displacement_at(entry_rad)` gives the shear displacement.
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

/// The same for a wheel that rolls straight. Throws std::domain_error when it would sink to its axle.
template <ContactLaw Law>
RimEquilibrium rimEquilibrium(const Law& law, const Wheel& wheel, const RimLoad& wanted) {
  const auto found = findEquilibrium<FineRimRule>(law, wheel, wanted, [&](double entry) {
    return ShearDisplacement{{wheel.radius_m, wanted.slip, entry}};
  });
  if (!found) detail::throwSunk(wanted.load_N);
  return *found;
}

}  // namespace talus::terramech
