#include <cmath>
#include <numbers>

#include <talus/terramech/contact/side_bulldozing.hpp>

namespace talus::terramech {

Hegedus hegedus(const PushedSoil& soil) {
  const double phi = std::atan(soil.tan_friction), x = 0.25 * std::numbers::pi - 0.5 * phi;
  const double cot_x = 1.0 / std::tan(x);
  const double front = cot_x + std::tan(x + phi);
  const double heap = cot_x + cot_x * cot_x * soil.tan_friction;
  return {front * soil.cohesion_Pa, 0.5 * front * heap * soil.weight_N_m3};
}

double faceResistance_N(const Hegedus& soil, const WheelFace& face) {
  const double theta = face.entry_angle_rad, r = face.radius_m;
  const double s = std::sin(theta), c = std::cos(theta);
  // Below 0.1 rad the closed forms cancel; the series have relative errors below 1e-8.
  const double t2 = theta * theta, t3 = t2 * theta;
  const bool small = theta < 0.1;
  const double area = small ? t3 * (2.0 / 3.0 - t2 * (2.0 / 15.0 - t2 * (4.0 / 315.0))) : theta - s * c;
  const double square = small ? t3 * t2 * (2.0 / 15.0 - t2 * (11.0 / 315.0 - t2 * (17.0 / 3780.0)))
                              : s - s * s * s / 3.0 - theta * c;
  return r * r * (soil.per_depth_Pa * area + 2.0 * r * soil.per_depth_squared_N_m3 * square);
}

}  // namespace talus::terramech
