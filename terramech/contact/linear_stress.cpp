#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/linear_stress.hpp>
#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

namespace {

// 1 - sin(h)/h. Below h = 0.1 the difference cancels, so the series is used; the first omitted term
// h^8/362880 is below 1e-13 relative.
double oneMinusSinc(double h) {
  if (h > 0.1) return 1.0 - std::sin(h) / h;
  const double q = h * h;
  return q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0)));
}

}  // namespace

LinearStressMoments::LinearStressMoments(double entry_angle_rad) : half_angle_rad(0.5 * entry_angle_rad) {
  const double h = half_angle_rad;
  const double s = std::sin(0.5 * h);
  peak_cos = 4.0 * std::cos(h) * s * s / h;
  peak_sin = 4.0 * std::sin(h) * s * s / h;
  offset_cos = 2.0 * s * s / h;
  offset_sin = oneMinusSinc(h);
}

double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample) {
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const double theta_m = 0.5 * theta_1;
  return wheel.radius_m * (theta_1 - theta_m - (1.0 - sample.slip) * (std::sin(theta_1) - std::sin(theta_m)));
}

Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  RangeCheck("linear stress").above("shear_modulus_m", shear_modulus_m, 0.0);
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const double bottom = wheel.radius_m * (theta_1 - (1.0 - sample.slip) * std::sin(theta_1));
  return {.peak = -std::expm1(-peakShearDisplacement_m(wheel, sample) / shear_modulus_m),
          .bottom = -std::expm1(-bottom / shear_modulus_m)};
}

double shearStrength_Pa(const Soil& soil, double normal_Pa) {
  return soil.cohesion_Pa + normal_Pa * std::tan(soil.friction_angle_rad);
}

double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = -std::expm1(-std::abs(displacement_m) / soil.shear_modulus_m);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = std::min(std::abs(displacement_m) / soil.shear_modulus_m, 1.0);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

}  // namespace talus::terramech
