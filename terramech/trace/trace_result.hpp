#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/trace/covariate_tests.hpp>
#include <talus/terramech/trace/effect_candidates.hpp>
#include <talus/terramech/trace/model_fit.hpp>
#include <talus/terramech/trace/trial.hpp>

namespace talus::terramech {

/// How residuals are traced.
struct TraceOptions {
  double significance = 0.005;  ///< family-wise level at which something is called missing
  int max_effects = 7;
  int fits = 7;                ///< candidates that are fitted inside the full model, a round
  int flips = 1999;            ///< of the significance test
  double library_bonus = 3.0;  ///< log odds by which a known form is believed before a curve
  bool fit_soil = false;       ///< the base soil is not given: it is fitted from the data
  std::uint64_t seed = 1;
};

/// A candidate that was fitted, and how well.
struct Explanation {
  Candidate candidate;  ///< with fitted parameters
  /// log-likelihood gained on held-out rows, less one a parameter; a known form has a bonus.
  double score = 0.0;
  double chi2_gain = 0.0;  ///< twice the log-likelihood gained on the rows that it was fitted to
  double in_sample = 0.0;  ///< half of chi2_gain less (parameters / 2) ln(rows), with the same bonus
  bool spoils = false;     ///< makes some channel's held-out error larger
  std::array<double, kChannels> by_channel{};  ///< chi2 gained in each channel
};

/// Root mean square of the scaled residual in each channel; NaN where nothing is measured.
using ChannelErrors = std::array<double, kChannels>;

/// An effect that was found.
struct TracedEffect {
  Explanation chosen;
  Channel channel = Channel::DrawbarPull;  ///< where it shows most
  std::vector<double> parameter_std;       ///< of the fitted model's parameters of chosen.candidate, in order
  double p_value = 1.0;                    ///< family-wise
  std::vector<Explanation> alternatives;   ///< others within 6 of its score, best first
  std::vector<Effect> correction;          ///< curves that carry what its form leaves in the same covariate
};

/// What tracing found.
struct TraceResult {
  RefinedModel base;     ///< as given or fitted, with its noise
  RefinedModel refined;  ///< base and the effects
  Trial trial;           ///< the rows, inputs calibrated
  std::vector<TracedEffect> effects;
  std::vector<Explanation> rejected;  ///< fitted and not chosen in the last round, or less likely than noise
  std::vector<CovariateTest> first_tests;  ///< of the base model, strongest first
  std::vector<CovariateTest> last_tests;   ///< of the refined model
  ChannelErrors base_rmse{}, refined_rmse{}, noise_floor{};
  std::optional<Estimate> first_prior;  ///< of the first effect's first parameter, known beside the model
  ExchangeableUnits units;              ///< rows whose errors were found to belong together
};

/// Root mean square of measured less predicted, scaled.
ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial);

}  // namespace talus::terramech
