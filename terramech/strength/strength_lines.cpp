#include <cmath>
#include <limits>
#include <stdexcept>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

namespace {

// Half the ranges of soils (thesis Table 2.3, dry to cohesive). A parameter with a larger standard deviation
// is not identified.
constexpr double kWidestCohesion_Pa = 5000.0;
constexpr double kWidestTanFriction = 0.25;

// K_1 = [1, x] with unit columns has the singular values sqrt(1 +- q), q = mean(x) / rms(x).
double scaledCondition(double mean, double variance) {
  const double spread = variance / (mean * mean + variance);  // 1 - q^2
  const double q = std::sqrt(std::max(0.0, 1.0 - spread));
  return std::sqrt((1.0 + q) * (1.0 + q) / spread);
}

}  // namespace

double ShearStrength::frictionAngle_rad() const {
  return std::atan(tan_friction);
}

void MohrCoulombLine::add(StressPair pair, double weight) {
  ++count_;
  moments_.add(pair.normal_Pa, pair.shear_Pa, weight);
}

double MohrCoulombLine::relativeResidual() const {
  const PairMoments& m = moments_;
  if (count_ < 3 || !(m.xx > 0.0)) return 0.0;
  return std::sqrt(std::max(0.0, m.yy - m.xy * m.xy / m.xx) / static_cast<double>(count_));
}

ShearStrength MohrCoulombLine::estimate() const {
  if (count_ < 2)
    throw std::domain_error("cohesion and friction: at least two samples are required, got " +
                            std::to_string(count_));
  const PairMoments& m = moments_;
  if (!(m.xx > 0.0)) {
    throw std::domain_error(
        "cohesion and friction: all samples have the same normal stress; vary load or slip");
  }
  ShearStrength fit;
  fit.samples = count_;
  fit.tan_friction = m.xy / m.xx;
  fit.cohesion_Pa = m.y - fit.tan_friction * m.x;
  const double squares = std::max(0.0, m.yy - fit.tan_friction * m.xy);
  const double variance =
      count_ > 2 ? squares / (static_cast<double>(count_) - 2.0) : std::numeric_limits<double>::quiet_NaN();
  fit.residual_std_Pa = std::sqrt(variance * static_cast<double>(count_) / m.weight);
  const double slope_variance = variance / m.xx;
  fit.covariance << variance / m.weight + slope_variance * m.x * m.x, -slope_variance * m.x,
      -slope_variance * m.x, slope_variance;
  fit.condition = scaledCondition(m.x, m.xx / m.weight);
  fit.unseen = unseenStrength(fit);
  return fit;
}

std::vector<std::string> unseenStrength(const ShearStrength& fit) {
  std::vector<std::string> unseen;
  const bool alike = fit.condition > kWorstCondition;
  if (alike || std::sqrt(fit.covariance(1, 1)) > kWidestTanFriction) {
    unseen.emplace_back(
        alike ? "friction_angle_rad: the normal stresses of the samples are almost equal; vary load or slip"
              : "friction_angle_rad: the samples scatter too much for their range of normal stress");
  }
  if (alike || std::sqrt(fit.covariance(0, 0)) > kWidestCohesion_Pa) {
    unseen.emplace_back(alike ? "cohesion_Pa: not identifiable at a single normal stress"
                              : "cohesion_Pa: the extrapolation to zero normal stress is too long");
  }
  return unseen;
}

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

StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample) {
  RangeCheck("wheel spin").above("sinkage_m", sample.sinkage_m, 0.0);
  const double area = wheel.width_m * contactChord_m(wheel, sample.sinkage_m);
  return {.normal_Pa = sample.load_N / area, .shear_Pa = sample.torque_Nm / (wheel.radius_m * area)};
}

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

}  // namespace talus::terramech
