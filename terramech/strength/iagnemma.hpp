#pragma once

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Wheel method of Iagnemma for cohesion and friction angle. The stresses are triangular along the rim with
/// the peak at theta_m = theta_1/2, half the entry angle (thesis App. B.3; iagnemma_2002). The method
/// over-estimates the cohesion of cohesive soil: without noise, by about 5 kPa on clay of 6 kPa. The
/// corrected method is in linear_offset.hpp.
namespace talus::terramech {

/// Peak stresses of the triangular stress distributions along the rim.
struct PeakStresses {
  double normal_Pa = 0.0;  ///< peak normal stress sigma_m
  double shear_Pa = 0.0;   ///< peak shear stress tau_m
};

/// Returns the peak stresses that carry the load and torque of a sample (thesis Eqs. B.6, B.7). Throws
/// std::invalid_argument unless 0 < sinkage < 2 r.
PeakStresses trianglePeaks(const Wheel& wheel, const WheelSample& sample);

/// Returns the equation c + K_j1 tan(phi) = K_j2 of one sample for a given shear modulus K (thesis Eqs. B.8,
/// B.11, B.12). The result is input of MohrCoulombLine. Throws std::domain_error if no shear is mobilised at
/// theta_m, i.e. the mobilised fraction A is <= 0; this occurs for a wheel with almost no slip and for a
/// braked wheel.
StressPair iagnemmaPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

}  // namespace talus::terramech
