#include <algorithm>
#include <cmath>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {

Channel TraceSearch::strongest(std::size_t effect) {
  RefinedModel without = model_;
  without.effects.erase(without.effects.begin() + static_cast<long>(effect));
  SolvedContacts solved = solved_;
  const Eigen::VectorXd moved = whitening_.marginal(
      trial_.measured.array().isFinite().select(predictRows(without, trial_, solved) - level_, 0.0));
  std::array<double, kChannels> size{};
  for (Eigen::Index i = 0; i < moved.size(); ++i)
    size[static_cast<std::size_t>(i % kChannels)] += moved[i] * moved[i];
  return static_cast<Channel>(std::max_element(size.begin(), size.end()) - size.begin());
}

void TraceSearch::finish(TraceResult& result) {
  const FitPlan plan = planFor(model_);
  // Without an effect the refined model is the base.
  if (!result.effects.empty()) model_ = fitModel(model_, trial_, whitening_, plan, solved_).model;
  model_.fitted = plan.free;
  const Eigen::MatrixXd covariance = parameterCovariance(model_, trial_, whitening_, plan, solved_);
  model_.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  level_ = predictRows(model_, trial_, solved_);
  std::size_t at = given_effects_;
  for (std::size_t k = 0; k < result.effects.size(); ++k) {
    auto& effect = result.effects[k];
    if (part_count_[k] == 1) effect.channel = strongest(at);
    for (Effect& part : effect.chosen.candidate.parts) part = model_.effects[at++];
    effect.parameter_std.clear();
    for (std::size_t j = 0; j < plan.free.size(); ++j) {
      const int e = plan.free[j].effect;
      if (e >= static_cast<int>(at - part_count_[k]) && e < static_cast<int>(at))
        effect.parameter_std.push_back(
            std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
    }
  }
  result.refined = model_;
  result.first_prior = first_prior_;
  const Trial measured = asMeasured(trial_);
  result.base_rmse = rmseOf(result.base, measured);
  result.refined_rmse = rmseOf(result.refined, measured);
  // What the sensors and the noisy inputs alone would leave, at the rows' own slip and load.
  const InputSlopes slopes = inputSlopes(model_, measured, solved_);
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < trial_.rows(); ++row) {
      const auto k = static_cast<int>(c);
      if (!std::isfinite(trial_.measured(row, k))) continue;
      const auto& n = model_.noise;
      const double slip = n.slipStd(trial_.slip[static_cast<std::size_t>(row)]);
      sum += std::pow(n.absolute[c] / trial_.denominator(row, static_cast<Channel>(k)), 2) +
             std::pow(n.relative[c] * level_(row, k), 2) + std::pow(slip * slopes.by_slip(row, k), 2) +
             std::pow(n.load_relative * slopes.by_load(row, k), 2);
      ++count;
    }
    result.noise_floor[c] = count ? std::sqrt(sum / count) : std::nan("");
  }
  result.shared = sharedError();
  result.trial = trial_;
}

}  // namespace talus::terramech
