#pragma once

#include <Eigen/Core>

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Linear-offset method of the thesis: triangular stresses plus a shear offset at the bottom, tau_offset = c
/// B (thesis section 2.2).
namespace talus::terramech {

/// Coefficients of M1 c tan(phi) + c + M3 tan(phi) = M4 for one sample (thesis Eqs. 2.9, 2.10; M2 = 1).
struct LinearOffsetCoefficients {
  double m1 = 0.0;  ///< [-]
  double m3_Pa = 0.0;
  double m4_Pa = 0.0;

  /// Returns the simplified equation c + M3 tan(phi) = M4 (thesis Eq. 2.11), for MohrCoulombLine.
  StressPair pair() const { return {.normal_Pa = m3_Pa, .shear_Pa = m4_Pa}; }
};

/// Returns M1, M3 and M4 of a sample. Throws std::invalid_argument unless 0 < sinkage < 2 r and K > 0,
/// std::domain_error if no shear is mobilised.
LinearOffsetCoefficients linearOffset(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Stresses of the linear-offset distribution [Pa] (thesis Eq. 2.1).
struct LinearOffsetStresses {
  double sigma_m_Pa = 0.0;
  double tau_m_Pa = 0.0;
  double tau_offset_Pa = 0.0;
};

/// Soil parameters of the linear-offset stresses.
struct ShearSoil {
  double cohesion_Pa = 0.0;
  double shear_modulus_m = 0.0;
};

/// Returns the stresses that carry the load and torque of the sample for a known c (thesis Eqs. 2.2, 2.3
/// corrected, 2.6):
///     tau_offset = c B
///     T = r^2 b theta_1 (tau_m/2 + tau_offset/4)
///     W = r b (sigma_m P/h + tau_m Q/h + tau_offset (1 - sin(h)/h))
LinearOffsetStresses linearOffsetStresses(const Wheel& wheel, const WheelSample& sample,
                                          const ShearSoil& soil);

/// Returns the drawbar pull [N] of the linear-offset stresses (thesis Eq. 3.1 over Eq. 2.1, in closed form).
double linearOffsetDrawbarPull_N(const Wheel& wheel, const WheelSample& sample, const ShearSoil& soil);

/// Recursive least squares of the complete Eq. 2.9, including M1, in constant memory.
///
/// The residual M1 c t + c + M3 t - M4, t = tan(phi), is linear in (c t, c, t, -1). The 4x4 Gram matrix of
/// (M1, 1, M3, M4) therefore contains all information of the samples, and estimate() minimises the sum of
/// squares by Gauss-Newton.
class LinearOffsetFit {
 public:
  void add(const LinearOffsetCoefficients& m);

  /// Returns the fit. Throws std::domain_error as MohrCoulombLine::estimate().
  ShearStrength estimate() const;

 private:
  MohrCoulombLine simplified_;  // initial values and condition number
  Eigen::Matrix4d gram_ = Eigen::Matrix4d::Zero();
};

}  // namespace talus::terramech
