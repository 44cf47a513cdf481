#pragma once

#include <cmath>
#include <limits>

namespace talus::terramech {

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

}  // namespace talus::terramech
