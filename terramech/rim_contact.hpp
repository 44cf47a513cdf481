#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include <terramech/gauss_legendre.hpp>
#include <terramech/shear_displacement.hpp>
#include <terramech/wheel.hpp>

/// Forces on a rigid rim from any stress laws, and the entry angle at which they carry a load. wong_reece.hpp
/// is the law of the literature; an effect that the literature's law lacks wraps it and is integrated by the
/// same code. Angles are measured from the downward vertical through the axle, positive towards the direction
/// of travel.
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
};

namespace detail {

inline constexpr auto kRimRule = gaussLegendre<24>();

/// Break points of the integral in t in [0, 1]: its ends and where the shear displacement changes sign.
struct Breaks {
  std::array<double, 4> t{0.0, 1.0, 1.0, 1.0};
  int count = 2;
};

Breaks breaks(const ShearDisplacement& displacement, double peak_rad, double exit_rad);

/// Sum of the forces of one point of the front half and its mirror point in the rear half, which share sigma
/// (C.3).
template <ContactLaw Law>
class RimIntegrand {
 public:
  RimIntegrand(const Law& law, const ShearDisplacement& displacement)
      : law_(law),
        displacement_(displacement),
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
        2.0 * displacement_.radius_m() * std::sin(0.5 * (entry_ + front)) * std::sin(0.5 * (entry_ - front));
    const double sigma = law_.pressure_Pa(depth_m);
    addPoint(front, sigma, (entry_ - peak_) * ds, sum);
    addPoint(rear, sigma, (peak_ - exit_) * ds, sum);
  }

 private:
  void addPoint(double theta, double sigma, double d_theta, RimForces& sum) const {
    const double tau = law_.shear_Pa(sigma, displacement_.at_m(theta));
    const double c = std::cos(theta), s = std::sin(theta);
    sum.load_N += (sigma * c + tau * s) * d_theta;
    sum.torque_Nm += tau * d_theta;
    sum.drawbar_pull_N += (tau * c - sigma * s) * d_theta;
  }

  const Law& law_;
  const ShearDisplacement& displacement_;
  double entry_, peak_, exit_;
};

}  // namespace detail

/// Forces on the rim at a given entry angle theta_1 in (0, pi/2] (thesis C.8 to C.10 with C.3's mirrored rear
/// half):
///   W  = r b   int_theta_2^theta_1 (sigma cos theta + tau sin theta) d theta
///   T  = r^2 b int tau d theta
///   DP = r b   int (tau cos theta - sigma sin theta) d theta
/// Each half runs from its end of contact to the peak in s = t^3, which makes sigma ~ s^n smooth for any n
/// that occurs; Gauss-Legendre of 24 points in t, split where the shear displacement changes sign. Relative
/// accuracy 1e-9 or better.
template <ContactLaw Law>
RimForces rimForces(const Law& law, const Wheel& wheel, const ShearDisplacement& displacement) {
  const detail::RimIntegrand<Law> integrand{law, displacement};
  const auto breaks = detail::breaks(displacement, integrand.peak_rad(), integrand.exit_rad());
  RimForces sum;
  for (int piece = 0; piece + 1 < breaks.count; ++piece) {
    const double start = breaks.t[static_cast<std::size_t>(piece)];
    const double length = breaks.t[static_cast<std::size_t>(piece) + 1] - start;
    for (std::size_t k = 0; k < detail::kRimRule.node.size(); ++k) {
      const double t = start + length * detail::kRimRule.node[k];
      integrand.add(t * t * t, 3.0 * t * t * length * detail::kRimRule.weight[k], sum);
    }
  }
  const double area = wheel.radius_m * wheel.width_m;
  return {sum.load_N * area, sum.torque_Nm * area * wheel.radius_m, sum.drawbar_pull_N * area};
}

/// A rim that carries its load.
struct RimEquilibrium {
  double entry_angle_rad = 0.0;
  RimForces forces;
};

/// What to solve for.
struct RimLoad {
  double load_N = 0.0;       ///< > 0
  double slip = 0.0;         ///< [-1, 1], see shear_displacement.hpp
  double first_guess = 0.1;  ///< entry angle to start from [rad]
  double growth = 3.0;       ///< d log W / d log theta_1 to start from [-]
};

namespace detail {

/// Search for the entry angle. The load grows almost as a power of it, so the secant method runs on
/// logarithms, inside a bracket that catches a step too far; four to six trials.
class EntrySearch {
 public:
  explicit EntrySearch(const RimLoad& wanted);

  /// The angle to try next [rad], in (0, pi/2].
  double entry_rad() const { return entry_; }

  /// Takes the load [N] found there. True when it is the one wanted; else entry_rad() has moved on. Throws
  /// std::domain_error when even the axle on the ground does not carry the load.
  bool take(double load_N);

 private:
  void learnGrowth(double log_ratio);
  double next(double log_ratio) const;

  double wanted_N_, entry_, growth_;
  double low_ = 0.0, high_ = 0.0;  // high 0: not met yet
  double last_log_entry_ = 0.0, last_log_ratio_ = 0.0;
  int trials_ = 0;
};

}  // namespace detail

/// The smallest entry angle in (0, pi/2] at which the rim carries the load. Throws std::domain_error when the
/// wheel would sink to its axle before it carried the load.
template <ContactLaw Law>
RimEquilibrium rimEquilibrium(const Law& law, const Wheel& wheel, const RimLoad& wanted) {
  detail::EntrySearch search{wanted};
  while (true) {
    const double entry = search.entry_rad();
    const RimForces forces = rimForces(law, wheel, ShearDisplacement{{wheel.radius_m, wanted.slip, entry}});
    if (search.take(forces.load_N)) return {entry, forces};
  }
}

}  // namespace talus::terramech
