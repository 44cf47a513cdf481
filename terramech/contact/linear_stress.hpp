#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>

namespace talus::terramech {

/// Moments of the triangular stress over the contact, with the peak at theta_m = h = theta_1/2 (thesis Eqs.
/// B.2, 2.1), each [-].
///
/// A stress of peak 1 that rises on [0, h] and falls on [h, theta_1] has
///     integral of cos = P/h,  P = 2 cos h - cos 2h - 1 = 4 cos h sin^2(h/2)
///     integral of sin = Q/h,  Q = 2 sin h - sin 2h     = 4 sin h sin^2(h/2)
/// The offset term 1 - theta/h on [0, h] has
///     integral of cos = (1 - cos h)/h,  integral of sin = 1 - sin(h)/h
/// (Eq. 2.3 corrected: the thesis prints another term). The product forms do not cancel at small h.
struct LinearStressMoments {
  explicit LinearStressMoments(double entry_angle_rad);

  double half_angle_rad;  ///< h
  double peak_cos;        ///< P/h
  double peak_sin;        ///< Q/h
  double offset_cos;      ///< (1 - cos h)/h
  double offset_sin;      ///< 1 - sin(h)/h
};

/// Share of the shear strength mobilised at theta_m = theta_1/2 and at the bottom theta = 0 (thesis Eq. 2.7)
/// [-]; each in [0, 1) for a driven wheel.
struct Mobilisation {
  double peak;    ///< A
  double bottom;  ///< B
};

/// Returns A and B of thesis Eq. 2.7 for a sample and the shear modulus K [m]. Throws std::invalid_argument
/// unless K > 0 and 0 <= sinkage_m < 2 r.
Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Returns the shear displacement j [m] at theta_m = theta_1/2 (thesis Eq. C.6).
double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample);

}  // namespace talus::terramech
