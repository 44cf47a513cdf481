#pragma once

#include <cmath>
#include <limits>

namespace talus::terramech {

/// Wheel travel per rolled arc, v / (r omega) [-], at a slip in [-1, 1]:
///   driven (slip >= 0): slip = 1 - v/(r omega), so 1 - slip; 0 for a wheel that spins in place;
///   braked (slip < 0):  slip = r omega/v - 1,   so 1/(1 + slip); infinite for a locked wheel.
/// Both agree at slip 0. (wong_2001, driven slip and skid)
inline double travelRatio(double slip) {
  if (slip >= 0.0) return 1.0 - slip;
  return slip > -1.0 ? 1.0 / (1.0 + slip) : std::numeric_limits<double>::infinity();
}

/// Slip angles beyond it, 89.94 deg, count as it: at 90 deg the travel along the wheel plane is nothing and
/// its tangent infinite, while their product, the travel across, is what shears the soil.
inline constexpr double kSteepestSlipAngle_rad = 1.5698;

/// How fast the rim slides over the ground in any direction, over the greater of rim and travel speed [-]:
///   s_R = |(r omega - v cos beta, v sin beta)| / max(r omega, v)
/// at a slip in [-1, 1] along the wheel plane and a slip angle beta [rad]: |slip| straight on, 1 locked, sqrt
/// 2 of a wheel that rolls at 90 deg. Ours; ding_2010 counts the part along the wheel plane.
double resultantSlip(double slip, double slip_angle_rad);

/// Shear traction or displacement of a wheel that also slides sideways.
struct Tangent {
  double along = 0.0;   ///< the wheel plane
  double across = 0.0;  ///< towards the side that the wheel slides to
};

/// The traction of a size along a displacement, which is the friction circle of an isotropic soil.
inline Tangent alongDisplacement(double size, const Tangent& displacement, double path) {
  const double unit = size / (path + 1e-300);
  return {unit * displacement.along, unit * displacement.across};
}

/// Shear displacement of the soil along a rim (thesis C.6, with travelRatio() in place of 1 - i so that it
/// holds for braked wheels too): j(theta) = r [(theta_1 - theta) - q (sin theta_1 - sin theta)], the path of
/// a rim point over the soil since it entered at theta_1. Positive where the rim drags the soil backwards.
class ShearDisplacement {
 public:
  /// What it depends on.
  struct Parameters {
    double radius_m;         ///< > 0
    double slip;             ///< [-1, 1]
    double entry_angle_rad;  ///< theta_1 in (0, pi/2]
  };

  explicit ShearDisplacement(const Parameters& p)
      : p_(p), travel_(travelRatio(p.slip)), sin_entry_(std::sin(p.entry_angle_rad)) {}

  double radius_m() const { return p_.radius_m; }
  double entryAngle_rad() const { return p_.entry_angle_rad; }

  /// j [m] at theta < theta_1; minus infinity everywhere behind the entry of a locked wheel.
  double at_m(double theta_rad) const {
    return p_.radius_m * ((p_.entry_angle_rad - theta_rad) - travel_ * (sin_entry_ - std::sin(theta_rad)));
  }

  /// The angle in (lowest_rad, theta_1) where j passes zero, or NaN where it keeps its sign. Only a braked or
  /// towed wheel has one: its rim runs ahead of the soil at the entry and lags behind it below.
  double signChange_rad(double lowest_rad) const;

 private:
  Parameters p_;
  double travel_;
  double sin_entry_;
};

/// Shear displacement of a wheel that also slides sideways at slip angle beta: along the wheel plane as
/// above, across it j_y = r q tan(beta) (theta_1 - theta), the same for every rim (ishigami_2007).
class SideSlipDisplacement {
 public:
  struct Parameters {
    double shear_radius_m;  ///< of the displacement along, > 0
    double radius_m;        ///< of the rim, > 0
    double slip;            ///< [-1, 1]
    double slip_angle_rad;  ///< beta, [-pi/2, pi/2], see kSteepestSlipAngle_rad
    double entry_angle_rad;
  };

  explicit SideSlipDisplacement(const Parameters& p);

  double radius_m() const { return p_.shear_radius_m; }
  double entryAngle_rad() const { return p_.entry_angle_rad; }
  /// The angle in (lowest_rad, theta_1) where the part along the wheel plane passes zero, or NaN.
  double signChange_rad(double lowest_rad) const;
  Tangent at_m(double theta_rad) const {
    const double arc = p_.entry_angle_rad - theta_rad;
    return {p_.shear_radius_m * (arc - travel_ * (sin_entry_ - std::sin(theta_rad))), lateral_m_ * arc};
  }

 private:
  Parameters p_;
  double travel_, lateral_m_, sin_entry_;
};

}  // namespace talus::terramech
