#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <terramech/closure_offset.hpp>
#include <terramech/held_out.hpp>
#include <terramech/model_validity.hpp>

namespace talus::terramech {
namespace {

constexpr double kLeastShare = 0.1, kFarOff = 0.15;

double spreadOf(const Trial& trial, int channel) {
  double n = 0.0, sum = 0.0, square = 0.0;
  for (double v : trial.measured.col(channel))
    if (std::isfinite(v)) n += 1.0, sum += v, square += v * v;
  return n > 1.0 ? std::sqrt(std::max(0.0, square / n - (sum / n) * (sum / n))) : 0.0;
}

double medianClosureError(const Trial& trial) {
  std::vector<double> errors;
  for (double e : closureErrors(trial))
    if (std::isfinite(e)) errors.push_back(std::abs(e));
  if (errors.size() < 8) return 0.0;
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2), errors.end());
  return errors[errors.size() / 2];
}

std::string number(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

}  // namespace

Applicability applicability(const TraceResult& result, const TraceOptions& options) {
  TraceResult physics = result;
  std::erase_if(physics.refined.effects, [](const Effect& e) { return e.empirical(); });
  const HeldOut held = holdOut(physics, options, foldsOf(result.trial));
  double best = -1.0;
  bool asked = false;
  for (int c = 0; c < kChannels; ++c) {
    const auto k = static_cast<std::size_t>(c);
    const double spread = spreadOf(result.trial, c);
    if (!result.trial.has(static_cast<Channel>(c)) || spread < 2.0 * result.noise_floor[k]) continue;
    asked = true;
    best = std::max(best, 1.0 - std::pow(held.refined_rmse[k] / spread, 2));
  }
  if (asked && best < kLeastShare)
    return {false,
            "on rows held out its physics predicts no channel better than that channel's mean (explained "
            "share of variance at most " +
                number(best) + "): a rigid wheel on soil does not describe them"};
  const double closure = medianClosureError(result.trial);
  if (closure > kFarOff && held.refined_rmse[0] > kFarOff)
    return {false,
            "drawbar pull differs by " + number(closure) +
                " of the load from what torque and sinkage allow a rigid wheel on any soil (median): no "
                "cohesion and friction can explain that"};
  return {};
}

}  // namespace talus::terramech
