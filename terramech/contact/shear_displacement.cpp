#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/shear_displacement.hpp>

namespace talus::terramech {

double ShearDisplacement::signChange_rad(double lowest_rad) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  // j exceeds 0 below the entry only if q cos theta_1 < 1. The maximum of j is at q cos theta = 1; below that
  // angle j falls.
  if (p_.slip >= 0.0 || !(travel_ * std::cos(p_.entry_angle_rad) < 1.0)) return kNone;
  double positive = std::acos(1.0 / travel_), negative = lowest_rad;
  if (at_m(negative) >= 0.0) return kNone;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (positive + negative);
    (at_m(middle) > 0.0 ? positive : negative) = middle;
  }
  return 0.5 * (positive + negative);
}

double resultantSlip(double slip, double slip_angle_rad) {
  const double beta = std::min(std::abs(slip_angle_rad), kSteepestSlipAngle_rad);
  const double c = std::cos(beta), s = std::sin(beta);
  if (slip < 0.0) return std::hypot(slip * c, s);  // divided by v, where r omega = (1 + slip) v cos beta
  return std::hypot(slip * c, (1.0 - slip) * s) /
         std::max(c, 1.0 - slip);  // divided by r omega; both times cos beta
}

SideSlipDisplacement::SideSlipDisplacement(const Parameters& p)
    : p_(p),
      travel_(std::min(travelRatio(p.slip), 1e6)),
      lateral_m_(p.radius_m * travel_ *
                 std::tan(std::clamp(p.slip_angle_rad, -kSteepestSlipAngle_rad, kSteepestSlipAngle_rad))),
      sin_entry_(std::sin(p.entry_angle_rad)) {}

double SideSlipDisplacement::signChange_rad(double lowest_rad) const {
  return ShearDisplacement{{p_.shear_radius_m, p_.slip, p_.entry_angle_rad}}.signChange_rad(lowest_rad);
}

}  // namespace talus::terramech
