#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// Moments of a triangular stress over the contact, peak at theta_m = h = theta_1/2 (thesis Eqs. B.2, 2.1),
/// each [-].
///
/// A stress of peak 1 rising on [0, h] and falling on [h, theta_1] has
///     integral of cos = P/h,  P = 2 cos h - cos 2h - 1 = 4 cos h sin^2(h/2)
///     integral of sin = Q/h,  Q = 2 sin h - sin 2h     = 4 sin h sin^2(h/2)
/// and the offset term 1 - theta/h on [0, h] has
///     integral of cos = (1 - cos h)/h,  integral of sin = 1 - sin(h)/h
/// (2.3 corrected: the thesis prints another term).
/// The product forms keep their digits at small h.
struct LinearStressMoments {
  explicit LinearStressMoments(double entry_angle_rad);

  double half_angle_rad;  ///< h
  double peak_cos;        ///< P/h
  double peak_sin;        ///< Q/h
  double offset_cos;      ///< (1 - cos h)/h
  double offset_sin;      ///< 1 - sin(h)/h
};

/// Shear mobilised at theta_m = theta_1/2 and at the bottom (thesis Eq. 2.7), each in [0, 1) for driven
/// wheels [-].
struct Mobilisation {
  double peak;    ///< A
  double bottom;  ///< B
};

/// A and B of thesis Eq. 2.7 for a sample and the shear modulus K [m]. Throws std::invalid_argument unless K
/// > 0.
Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Shear displacement j(theta_m) at theta_m = theta_1/2 [m] (thesis Eq. C.6).
double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample);

}  // namespace talus::terramech
