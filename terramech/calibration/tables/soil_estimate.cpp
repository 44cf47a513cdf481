#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/tables/method_estimates.hpp>

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

namespace {

void requireOneOf(const std::string& word, const std::vector<std::string>& words, const std::string& what) {
  if (std::ranges::find(words, word) != words.end()) return;
  std::string list;
  for (const std::string& other : words) list += (list.empty() ? "" : ", ") + other;
  throw InputError(
      {.where = what + " '" + word + "'", .reason = "is unknown", .remedy = "there are " + list});
}

void validate(const EstimateOptions& options) {
  requireOneOf(options.method, estimateMethods(), "--method");
  if (!options.shear_modulus.empty() && !statedModulus(options))
    requireOneOf(options.shear_modulus, modulusMethods(), "--shear-modulus");
  if (options.plate_width_m > 0.0 && options.method != "bevameter") {
    throw InputError({.where = "--plate-width",
                      .reason = "applies to plate tests only",
                      .remedy = "use --method bevameter, or remove the option"});
  }
}

}  // namespace

const std::vector<std::string>& estimateMethods() {
  static const std::vector<std::string> names{"bevameter", "sojourner", "iagnemma", "linear-offset",
                                              "wong-reece"};
  return names;
}

const std::vector<std::string>& modulusMethods() {
  static const std::vector<std::string> names{"error-minimisation", "effective-torque",
                                              "effective-torque-printed", "joint"};
  return names;
}

SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch) {
  validate(options);
  if (options.method == "wong-reece" || !options.model.empty()) return modelEstimate(options, watch);
  if (options.method != "bevameter") return lineEstimate(options, watch);
  if (options.recursive) {
    throw InputError({.where = "--recursive",
                      .reason = "cannot be combined with --method bevameter, which fits a whole test at once",
                      .remedy = "remove one of the two"});
  }
  return plateEstimate(options, watch);
}

}  // namespace talus::terramech
