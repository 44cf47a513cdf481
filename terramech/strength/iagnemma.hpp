#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Wheel method of Iagnemma: triangular stresses, theta_m = theta_1/2 (thesis App. B.3; iagnemma_2002). The
/// method over-estimates the cohesion of cohesive soil: without noise, by about 5 kPa on clay of 6 kPa;
/// linear_offset.hpp has the corrected method.
namespace talus::terramech {

/// Peak stresses of the triangular distributions [Pa].
struct PeakStresses {
  double normal_Pa = 0.0;  ///< sigma_m
  double shear_Pa = 0.0;   ///< tau_m
};

/// Returns the peaks sigma_m and tau_m that carry the load and torque of the sample (thesis Eqs. B.6, B.7).
/// Throws std::invalid_argument unless 0 < sinkage < 2 r.
PeakStresses trianglePeaks(const Wheel& wheel, const WheelSample& sample);

/// Returns the equation c + K_j1 tan(phi) = K_j2 of one sample (thesis Eqs. B.8, B.11, B.12), for
/// MohrCoulombLine. Throws std::domain_error if no shear is mobilised at theta_m (A <= 0: a wheel with almost
/// no slip, or braked).
StressPair iagnemmaPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

}  // namespace talus::terramech
