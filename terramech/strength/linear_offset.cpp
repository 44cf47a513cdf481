#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>

#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/contact/linear_stress.hpp>
#include <talus/terramech/strength/iagnemma.hpp>
#include <talus/terramech/strength/linear_offset.hpp>

namespace talus::terramech {
namespace {

// Unit of stress that keeps the Gram matrix well scaled.
constexpr double kStressUnit_Pa = 1e4;

// 1 - 4 sin(h)/theta_1 + sin(theta_1)/theta_1 = (1 - sinc h) - sinc(h) (1 - cos h), without cancellation.
double offsetLoad(const LinearStressMoments& m) {
  const double h = m.half_angle_rad;
  return m.offset_sin - std::sin(h) * m.offset_cos;
}

// Vector (c t, c, t, -1), whose product with (M1, 1, M3, M4) is the residual; derivative() is by (c, t).
Eigen::Vector4d unknowns(const Eigen::Vector2d& x) {
  return {x[0] * x[1], x[0], x[1], -1.0};
}

Eigen::Matrix<double, 4, 2> derivative(const Eigen::Vector2d& x) {
  Eigen::Matrix<double, 4, 2> d;
  d << x[1], x[0], 1.0, 0.0, 0.0, 1.0, 0.0, 0.0;
  return d;
}

Eigen::Vector2d minimise(const Eigen::Matrix4d& gram, Eigen::Vector2d x) {
  for (int pass = 0; pass < 50; ++pass) {
    const auto d = derivative(x);
    const Eigen::Vector2d step = (d.transpose() * gram * d).inverse() * (d.transpose() * gram * unknowns(x));
    x -= step;
    if (step.norm() < 1e-14 * (1.0 + x.norm())) break;
  }
  return x;
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

double linearOffsetDrawbarPull_N(const Wheel& wheel, const WheelSample& sample, const ShearSoil& soil) {
  const LinearOffsetStresses s = linearOffsetStresses(wheel, sample, soil);
  const LinearStressMoments m(entryAngle_rad(wheel, sample.sinkage_m));
  return wheel.radius_m * wheel.width_m *
         (s.tau_m_Pa * m.peak_cos + s.tau_offset_Pa * m.offset_cos - s.sigma_m_Pa * m.peak_sin);
}

void LinearOffsetFit::add(const LinearOffsetCoefficients& m) {
  simplified_.add(m.pair());
  const Eigen::Vector4d row(m.m1, 1.0, m.m3_Pa / kStressUnit_Pa, m.m4_Pa / kStressUnit_Pa);
  gram_ += row * row.transpose();
}

ShearStrength LinearOffsetFit::estimate() const {
  ShearStrength fit = simplified_.estimate();
  const Eigen::Vector2d x = minimise(gram_, {fit.cohesion_Pa / kStressUnit_Pa, fit.tan_friction});
  const auto d = derivative(x);
  const auto n = static_cast<double>(fit.samples);
  const double squares = std::max(0.0, unknowns(x).dot(gram_ * unknowns(x)));
  const double variance = fit.samples > 2 ? squares / (n - 2.0) : std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix2d covariance = variance * (d.transpose() * gram_ * d).inverse();
  const Eigen::Vector2d unit(kStressUnit_Pa, 1.0);
  fit.cohesion_Pa = x[0] * kStressUnit_Pa;
  fit.tan_friction = x[1];
  fit.residual_std_Pa = std::sqrt(variance) * kStressUnit_Pa;
  fit.covariance = unit.asDiagonal() * covariance * unit.asDiagonal();
  fit.unseen = unseenStrength(fit);
  return fit;
}

}  // namespace talus::terramech
