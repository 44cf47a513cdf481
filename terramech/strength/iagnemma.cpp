#include <stdexcept>

#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/contact/linear_stress.hpp>
#include <talus/terramech/numerics/range.hpp>
#include <talus/terramech/strength/iagnemma.hpp>

namespace talus::terramech {

PeakStresses trianglePeaks(const Wheel& wheel, const WheelSample& sample) {
  RangeCheck("wheel method").above("sinkage_m", sample.sinkage_m, 0.0);
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const LinearStressMoments m(theta_1);
  const double area = wheel.radius_m * wheel.width_m;
  const double tau_m = 2.0 * sample.torque_Nm / (wheel.radius_m * area * theta_1);  // (B.6)
  const double sigma_m = (sample.load_N / area - m.peak_sin * tau_m) / m.peak_cos;  // (B.7)
  return {.normal_Pa = sigma_m, .shear_Pa = tau_m};
}

StressPair iagnemmaPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  const PeakStresses peak = trianglePeaks(wheel, sample);
  const double a = mobilisation(wheel, sample, shear_modulus_m).peak;
  if (!(a > 0.0))
    throw std::domain_error("wheel method: no shear mobilised at theta_m; it needs a driven, slipping wheel");
  return {.normal_Pa = peak.normal_Pa, .shear_Pa = peak.shear_Pa / a};
}

}  // namespace talus::terramech
