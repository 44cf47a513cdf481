#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Iagnemma's wheel method: triangular stresses, theta_m = theta_1/2 (thesis App. B.3; iagnemma_2002).
/// It over-estimates cohesion on cohesive soil (by about 5 kPa on clay of 6 kPa, noise-free): see
/// linear_offset.hpp.
namespace talus::terramech {

/// Peak stresses of the triangular distributions [Pa].
struct PeakStresses {
  double normal_Pa = 0.0;  ///< sigma_m
  double shear_Pa = 0.0;   ///< tau_m
};

/// sigma_m and tau_m that carry the sample's load and torque (thesis Eqs. B.6, B.7).
/// Throws std::invalid_argument unless 0 < sinkage < 2 r.
PeakStresses trianglePeaks(const Wheel& wheel, const WheelSample& sample);

/// The equation c + K_j1 tan(phi) = K_j2 of one sample (thesis Eqs. B.8, B.11, B.12); feed it to
/// MohrCoulombLine. Throws std::domain_error where no shear is mobilised at theta_m (A <= 0: a wheel that
/// hardly slips, or is braked).
StressPair iagnemmaPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

}  // namespace talus::terramech
