#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

std::optional<double> statedModulus(const EstimateOptions& options) {
  const std::string& word = options.shear_modulus;
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  if (value > 0.0 && std::isfinite(value)) return value;
  throw InputError({.where = "--shear-modulus " + word, .reason = "must be > 0 [m]", .remedy = ""});
}

SoilEstimate::SoilEstimate()
    : cohesion_Pa(RunningSoil::kNan),
      tan_friction(RunningSoil::kNan),
      shear_modulus_m(RunningSoil::kNan),
      covariance(Eigen::Matrix2d::Constant(RunningSoil::kNan)),
      friction_angle_rad(RunningSoil::kNan),
      sinkage_exponent(RunningSoil::kNan) {}

void SoilEstimate::take(const ShearStrength& fit) {
  cohesion_Pa = fit.cohesion_Pa;
  tan_friction = fit.tan_friction;
  friction_angle_rad = fit.frictionAngle_rad();
  covariance = fit.covariance;
  unseen.insert(unseen.end(), fit.unseen.begin(), fit.unseen.end());
}

std::string SoilEstimate::implausible() const {
  constexpr double kSteepest = 1.7320508075688772;  // tan 60 deg
  const double c = cohesion_Pa + 2.0 * std::sqrt(covariance(0, 0));
  const double two_std = 2.0 * std::sqrt(covariance(1, 1));
  const bool no_cohesion = c < 0.0;
  const bool no_friction = tan_friction + two_std < 0.0 || tan_friction - two_std > kSteepest;
  if (!no_cohesion && !no_friction) return {};
  return fmt::format(
      "{} outside the range of any soil: the rows violate the assumptions of the method (one soil, no "
      "slip-sinkage, no grousers)",
      no_cohesion && no_friction ? "a cohesion and a friction angle"
      : no_cohesion              ? "a cohesion"
                                 : "a friction angle");
}

double frictionStd_rad(const Eigen::Matrix2d& covariance, double friction_angle_rad) {
  return std::sqrt(covariance(1, 1)) * std::pow(std::cos(friction_angle_rad), 2);
}

}  // namespace talus::terramech
