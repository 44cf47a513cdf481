#include <algorithm>
#include <cmath>

#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/verdict/model_soil.hpp>
#include <talus/terramech/calibration/verdict/verdict.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace talus::terramech {
namespace {

constexpr double kUndeterminedShare = 0.9;  // greatest posterior over prior std of a determined parameter

int indexOf(const std::string& name) {
  const auto& all = soilParameters();
  return static_cast<int>(std::ranges::find_if(all, [&](const SoilParameter& p) { return p.name == name; }) -
                          all.begin());
}

SensorNoise noiseOf(const RefinedModel& model, double relative) {
  SensorNoise noise = model.noise;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (noise.absolute[c] == 0.0 && noise.relative[c] == 0.0) noise.relative[c] = relative;
  if (noise.slip_absolute == 0.0 && noise.slip_relative == 0.0) noise.slip_relative = relative;
  if (noise.load_relative == 0.0) noise.load_relative = relative;
  return noise;
}

/// Plan of a fit with only the soil parameters free.
FitPlan planOf(const RefinedModel& model, const ModelSoilOptions& options) {
  FitPlan plan = options.prior ? fitPlan(*options.prior, false) : fitPlan(model, true);
  const int shear = options.shear_modulus_m ? indexOf("shear_modulus_m") : -1;
  std::erase_if(plan.free, [&](const FittedParameter& p) { return p.effect >= 0 || p.index == shear; });
  plan.iterations = 40;
  return plan;
}

/// State of the fit: the model, and the noise at its current predictions.
class SoilModelFit {
 public:
  SoilModelFit(const Trial& trial, const FitPlan& plan, double noise)
      : trial_(trial), plan_(plan), noise_(noise) {
    // Slip and load of each row are fitted from their readings alone.
    const auto rows = static_cast<std::size_t>(trial_.rows());
    for (std::size_t row = 0; row < rows; ++row) slips_.push_back(trial_.slip[row]);
  }

  Fit from(RefinedModel model) {
    model.noise = noiseOf(model, noise_);
    for (Eigen::Index row = 0; row < trial_.rows(); ++row) {
      const double slip = slips_[static_cast<std::size_t>(row)];
      trial_.slip_variance[row] = std::pow(model.noise.slipStd(slip), 2);
      trial_.load_variance[row] = std::pow(model.noise.load_relative, 2);
    }
    Fit fit{.model = model};
    for (int round = 0; round < 3; ++round) {
      white_ = whiteningBy(fit.model);
      fit = fitModel(fit.model, trial_, white_, plan_, solved_);
    }
    return fit;
  }

  /// Covariance of the free parameters, in the order of the plan.
  Eigen::MatrixXd covariance(const RefinedModel& fitted) {
    return parameterCovariance(fitted, trial_, whiteningBy(fitted), plan_, solved_);
  }

  /// Degrees of freedom: readings minus free parameters, at least 1.
  double freedom() const {
    const auto readings = static_cast<double>(trial_.measured.array().isFinite().count());
    return std::max(1.0, readings - static_cast<double>(plan_.free.size()));
  }

 private:
  Whitening whiteningBy(const RefinedModel& model) {
    const Eigen::MatrixXd level = predictRows(model, trial_, solved_);
    return whitening(trial_, level, inputSlopes(model, trial_, solved_), model.noise);
  }

  Trial trial_;
  const FitPlan& plan_;
  double noise_;
  std::vector<double> slips_;
  Whitening white_;
  SolvedContacts solved_;
};

RefinedModel withSoil(const RefinedModel& model, const Soil& soil, const ModelSoilOptions& options) {
  RefinedModel other = model;
  other.soil = soil;
  if (options.shear_modulus_m) other.soil.shear_modulus_m = *options.shear_modulus_m;
  return other;
}

/// Covariance of cohesion c and tan phi (phi: friction angle) from that of the fitted parameters; zero for
/// parameters that are not fitted.
Eigen::Matrix2d strengthCovariance(const FitPlan& plan, const Eigen::MatrixXd& covariance, const Soil& soil) {
  const double by_phi = 1.0 + std::pow(std::tan(soil.friction_angle_rad), 2);
  const std::array<int, 2> index{indexOf("cohesion_Pa"), indexOf("friction_angle_rad")};
  const std::array<double, 2> slope{1.0, by_phi};
  Eigen::Matrix2d strength = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < plan.free.size(); ++i)
    for (std::size_t j = 0; j < plan.free.size(); ++j)
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b)
          if (plan.free[i].index == index[a] && plan.free[j].index == index[b])
            strength(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
                slope[a] * slope[b] * covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return strength;
}

}  // namespace

ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options) {
  const FitPlan plan = planOf(model, options);
  SoilModelFit search{trial, plan, options.noise};
  const Soil& afresh = options.prior ? options.prior->soil : unknownSoil().model.soil;
  Fit best = search.from(withSoil(model, afresh, options));
  // With a prior, the soil of the model is not a start value, because the prior may fix parameters.
  if (!options.prior) {
    const Fit own = search.from(withSoil(model, model.soil, options));
    if (own.cost() < best.cost()) best = own;
  }
  const Eigen::MatrixXd covariance = search.covariance(best.model);
  ModelSoil found{.soil = best.model.soil,
                  .strength_covariance = strengthCovariance(plan, covariance, best.model.soil),
                  .misfit = best.chi2 / search.freedom()};
  best.model.fitted = plan.free;
  for (const std::string& name : soilAtBounds(best.model))
    found.unseen.push_back(name + ": ended at the limit of its range");
  for (std::size_t k = 0; k < plan.free.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const double prior = plan.soil_prior.at(plan.free[k].index).std;
    if (std::sqrt(std::max(0.0, covariance(at, at))) > kUndeterminedShare * prior)
      found.unseen.push_back(
          std::string(soilParameters()[static_cast<std::size_t>(plan.free[k].index)].name) +
          ": the posterior is almost as wide as the prior");
  }
  return found;
}

}  // namespace talus::terramech
