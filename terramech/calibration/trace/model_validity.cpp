#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>

namespace talus::terramech {
namespace {

constexpr double kLeastShare = 0.5, kFarOff = 0.15, kLoudest = 0.25;

/// Greatest DP/W and T/(rW) that a wheel reaches on soil [-].
constexpr double kMostPull = 1.0, kMostTorque = 1.5;

Estimate scatterOf(const Trial& trial, int channel) {
  double n = 0.0, sum = 0.0, square = 0.0;
  for (double v : trial.measured.col(channel))
    if (std::isfinite(v)) n += 1.0, sum += v, square += v * v;
  if (n < 2.0) return {};
  return {sum / n, std::sqrt(std::max(0.0, square / n - (sum / n) * (sum / n)))};
}

/// Returns true if the scatter of a channel exceeds twice its noise or, for torque and sinkage, kLoudest of
/// its mean.
bool moves(const Estimate& scatter, int channel, double noise_floor) {
  const bool ratio =
      channel == static_cast<int>(Channel::Sinkage) || channel == static_cast<int>(Channel::Torque);
  return scatter.std > 2.0 * noise_floor || (ratio && scatter.std > kLoudest * std::abs(scatter.value));
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double medianClosureError(const Trial& trial) {
  std::vector<double> errors;
  for (double e : closureErrors(trial))
    if (std::isfinite(e)) errors.push_back(std::abs(e));
  return errors.size() < 8 ? 0.0 : medianOf(std::move(errors));
}

/// Median of a channel over the rows; 0 if it is not measured.
double medianReading(const Trial& trial, Channel channel) {
  std::vector<double> values;
  for (double v : trial.measured.col(static_cast<Eigen::Index>(channel)))
    if (std::isfinite(v)) values.push_back(std::abs(v));
  return medianOf(std::move(values));
}

std::string number(double value) {
  char text[24];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

}  // namespace

std::vector<double> closureErrors(const Trial& trial) {
  std::vector<double> errors;
  for (int row = 0; row < trial.rows(); ++row) {
    const double pull = trial.measured(row, 0), z = trial.measured(row, 1), torque = trial.measured(row, 2);
    const double entry = std::acos(std::clamp(1.0 - z, 0.0, 1.0 - 1e-9));
    const double arc = std::sin(0.25 * entry) / (0.25 * entry);
    // (T47)
    errors.push_back(pull + std::tan(0.5 * entry) - arc * arc / std::cos(0.5 * entry) * torque);
  }
  return errors;
}

Applicability applicability(const TraceResult& result, const TraceOptions& options) {
  for (const auto& [channel, most] :
       {std::pair{Channel::DrawbarPull, kMostPull}, {Channel::Torque, kMostTorque}})
    if (const double median = medianReading(result.trial, channel); median > most)
      return {false,
              std::string("the median of ") + name(channel) + " is " + number(median) +
                  ", more than a wheel reaches on soil (" + number(most) +
                  "): check the units of the readings and of the wheel",
              false};
  TraceResult physics = result;
  physics.scope = {};
  physics.refined = withoutSensors(result.refined);
  std::erase_if(physics.refined.effects, [](const Effect& e) { return e.empirical(); });
  const HeldOut held = holdOut(physics, options, foldsOf(result.trial));
  int asked = 0, silent = 0;
  bool absurd = false;
  std::string shares;
  for (int c = 0; c < kChannels; ++c) {
    const auto k = static_cast<std::size_t>(c);
    if (!result.trial.has(static_cast<Channel>(c))) continue;
    const Estimate scatter = scatterOf(result.trial, c);
    if (!moves(scatter, c, result.noise_floor[k])) continue;
    const double share = 1.0 - std::pow(held.refined_rmse[k] / scatter.std, 2);
    ++asked;
    silent += share < kLeastShare;
    absurd |= share < -1.0;
    shares += std::string(shares.empty() ? "" : ", ") + name(static_cast<Channel>(c)) + " " + number(share);
  }
  if (absurd || (asked > 0 && silent == asked))
    return {false, "on held-out rows its physics explains too little of the variance (" + shares +
                       "): the model of a rigid wheel on soil does not fit"};
  const double closure = medianClosureError(result.trial);
  if (closure > kFarOff && held.refined_rmse[0] > kFarOff)
    return {false, "drawbar pull differs by " + number(closure) +
                       " of the load (median) from the value that torque and sinkage imply for a rigid wheel "
                       "on any soil: no cohesion and friction angle explain it"};
  return {};
}

}  // namespace talus::terramech
