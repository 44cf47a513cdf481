#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Linear-offset method of the thesis for cohesion c and friction angle phi: triangular stresses along the
/// rim plus a shear offset tau_offset = c B at the bottom of the wheel (thesis section 2.2). A and B are the
/// fractions of the shear strength that are mobilised at the stress peak and at the bottom
/// (linear_stress.hpp).
namespace talus::terramech {

/// Coefficients of the equation M1 c tan(phi) + c + M3 tan(phi) = M4 of one sample (thesis Eqs. 2.9, 2.10; M2
/// = 1).
struct LinearOffsetCoefficients {
  double m1 = 0.0;     ///< M1 [-]
  double m3_Pa = 0.0;  ///< M3
  double m4_Pa = 0.0;  ///< M4

  /// Returns the simplified equation c + M3 tan(phi) = M4 (thesis Eq. 2.11), the input of MohrCoulombLine.
  StressPair pair() const { return {.normal_Pa = m3_Pa, .shear_Pa = m4_Pa}; }
};

/// Returns M1, M3 and M4 of a sample for a given shear modulus K. Throws std::invalid_argument unless 0 <
/// sinkage < 2 r and K > 0, and std::domain_error if no shear is mobilised.
LinearOffsetCoefficients linearOffset(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Stresses of the linear-offset distribution along the rim (thesis Eq. 2.1).
struct LinearOffsetStresses {
  double sigma_m_Pa = 0.0;     ///< peak normal stress sigma_m
  double tau_m_Pa = 0.0;       ///< peak shear stress tau_m
  double tau_offset_Pa = 0.0;  ///< shear offset at the bottom of the wheel
};

/// Soil parameters that linearOffsetStresses() requires.
struct ShearSoil {
  double cohesion_Pa = 0.0;      ///< cohesion c
  double shear_modulus_m = 0.0;  ///< shear deformation modulus K
};

/// Returns the stresses that carry the load W and torque T of a sample for a known cohesion c (thesis Eqs.
/// 2.2, 2.3 corrected, 2.6). h = theta_1/2, P and Q are those of linear_stress.hpp:
///     tau_offset = c B
///     T = r^2 b theta_1 (tau_m/2 + tau_offset/4)
///     W = r b (sigma_m P/h + tau_m Q/h + tau_offset (1 - sin(h)/h))
LinearOffsetStresses linearOffsetStresses(const Wheel& wheel, const WheelSample& sample,
                                          const ShearSoil& soil);

}  // namespace talus::terramech
