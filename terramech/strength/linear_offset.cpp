#include <cmath>

#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/contact/linear_stress.hpp>
#include <talus/terramech/strength/iagnemma.hpp>
#include <talus/terramech/strength/linear_offset.hpp>

namespace talus::terramech {
namespace {

// 1 - 4 sin(h)/theta_1 + sin(theta_1)/theta_1 = (1 - sinc h) - sinc(h) (1 - cos h), without cancellation.
double offsetLoad(const LinearStressMoments& m) {
  const double h = m.half_angle_rad;
  return m.offset_sin - std::sin(h) * m.offset_cos;
}

}  // namespace

LinearOffsetCoefficients linearOffset(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  const StressPair triangle = iagnemmaPair(wheel, sample, shear_modulus_m);
  const auto [a, b] = mobilisation(wheel, sample, shear_modulus_m);
  const LinearStressMoments m(entryAngle_rad(wheel, sample.sinkage_m));
  const double share = 1.0 + b / (2.0 * a);
  return {.m1 = -offsetLoad(m) * b / (m.peak_cos * share),
          .m3_Pa = triangle.normal_Pa / share,
          .m4_Pa = triangle.shear_Pa / share};
}

LinearOffsetStresses linearOffsetStresses(const Wheel& wheel, const WheelSample& sample,
                                          const ShearSoil& soil) {
  const LinearStressMoments m(entryAngle_rad(wheel, sample.sinkage_m));
  const double area = wheel.radius_m * wheel.width_m;
  LinearOffsetStresses s;
  s.tau_offset_Pa = soil.cohesion_Pa * mobilisation(wheel, sample, soil.shear_modulus_m).bottom;
  s.tau_m_Pa = trianglePeaks(wheel, sample).shear_Pa - 0.5 * s.tau_offset_Pa;
  s.sigma_m_Pa =
      (sample.load_N / area - m.peak_sin * s.tau_m_Pa - m.offset_sin * s.tau_offset_Pa) / m.peak_cos;
  return s;
}

}  // namespace talus::terramech
