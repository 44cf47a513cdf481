#pragma once

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Integrals of a triangular stress over the contact arc of a wheel, weighted with the cosine and sine of the
/// rim angle theta. The stress peak is at half the entry angle, theta_m = h = theta_1/2 (thesis Eqs. B.2,
/// 2.1). Every integral is dimensionless.
///
/// A stress with peak value 1 that rises linearly on [0, h] and falls linearly on [h, theta_1] has the
/// integrals
///     integral of cos = P/h,  P = 2 cos h - cos 2h - 1 = 4 cos h sin^2(h/2)
///     integral of sin = Q/h,  Q = 2 sin h - sin 2h     = 4 sin h sin^2(h/2)
/// The shear offset at the bottom of the wheel, 1 - theta/h on [0, h], has the integrals
///     integral of cos = (1 - cos h)/h,  integral of sin = 1 - sin(h)/h
/// Thesis Eq. 2.3 prints another term for this offset; the integrals here are the corrected ones. The product
/// forms of P and Q do not cancel at small h.
struct LinearStressMoments {
  explicit LinearStressMoments(double entry_angle_rad);

  double half_angle_rad;  ///< h = theta_1/2 [rad]
  double peak_cos;        ///< P/h
  double peak_sin;        ///< Q/h
  double offset_cos;      ///< (1 - cos h)/h
  double offset_sin;      ///< 1 - sin(h)/h
};

/// Fraction of the shear strength that is mobilised at two angles of the rim (thesis Eq. 2.7) [-]. Each
/// fraction is in [0, 1) for a driven wheel.
struct Mobilisation {
  double peak;    ///< A, at the stress peak theta_m = theta_1/2
  double bottom;  ///< B, at the bottom of the wheel, theta = 0
};

/// Returns the mobilised fractions A and B of thesis Eq. 2.7 for one telemetry sample and a shear deformation
/// modulus K = shear_modulus_m. Throws std::invalid_argument unless K > 0 and 0 <= sinkage_m < 2 r.
Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Returns the shear displacement j [m] of the soil at the stress peak theta_m = theta_1/2 (thesis Eq. C.6).
double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample);

/// Shear strength and shear stress of a soil under a plate or a wheel rim.

/// Returns the Mohr-Coulomb strength tau_max = c + sigma tan phi [Pa] (thesis Eq. A.2) at the normal stress
/// sigma = normal_Pa >= 0.
double shearStrength_Pa(const Soil& soil, double normal_Pa);

/// Returns the shear stress of Janosi and Hanamoto, tau = tau_max (1 - e^{-|j|/K}) [Pa] (thesis Eq. A.4;
/// janosi_hanamoto_1961), with the sign of the shear displacement j = displacement_m.
double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m);

/// Returns the shear stress of the idealised elasto-plastic law, tau = tau_max min(|j|/K, 1) [Pa], with the
/// sign of the shear displacement j = displacement_m. The law is thesis Eq. A.3, where j is named strain.
double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m);

}  // namespace talus::terramech
