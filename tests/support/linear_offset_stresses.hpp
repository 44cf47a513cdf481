#pragma once

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Stresses of the linear-offset distribution along the rim (thesis Eq. 2.1).
struct LinearOffsetStresses {
  double sigma_m_Pa = 0.0;     ///< peak normal stress sigma_m
  double tau_m_Pa = 0.0;       ///< peak shear stress tau_m
  double tau_offset_Pa = 0.0;  ///< shear offset at the bottom of the wheel
};

/// Returns the stresses that carry the load W and torque T of a sample for a known cohesion c and shear modulus K
/// (thesis Eqs. 2.2, 2.3 corrected, 2.6). h = theta_1/2, P and Q are those of the linear stress law:
///     tau_offset = c B
///     T = r^2 b theta_1 (tau_m/2 + tau_offset/4)
///     W = r b (sigma_m P/h + tau_m Q/h + tau_offset (1 - sin(h)/h))
inline LinearOffsetStresses linearOffsetStresses(const Wheel& wheel, const WheelSample& sample,
                                                 double cohesion_Pa, double shear_modulus_m) {
  const LinearStressMoments m(entryAngle_rad(wheel, sample.sinkage_m));
  LinearOffsetStresses s;
  s.tau_offset_Pa = cohesion_Pa * mobilisation(wheel, sample, shear_modulus_m).bottom;
  s.tau_m_Pa = trianglePeaks(wheel, sample).shear_Pa - 0.5 * s.tau_offset_Pa;
  s.sigma_m_Pa = (sample.load_N / (wheel.radius_m * wheel.width_m) - m.peak_sin * s.tau_m_Pa -
                  m.offset_sin * s.tau_offset_Pa) /
                 m.peak_cos;
  return s;
}

}  // namespace talus::terramech
