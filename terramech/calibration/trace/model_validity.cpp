#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {
namespace {

constexpr double kLeastShare = 0.5, kFarOff = 0.15, kLoudest = 0.25;

/// Greatest DP/W and T/(rW) that a wheel reaches on soil [-].
constexpr double kMostPull = 1.0, kMostTorque = 1.5;

Estimate scatterOf(const Trial& trial, int channel) {
  PairMoments m;
  for (double v : trial.measured.col(channel))
    if (std::isfinite(v)) m.add(v, 0.0);
  return m.weight < 2.0 ? Estimate{} : Estimate{m.x, std::sqrt(m.xx / m.weight)};
}

/// Returns true if the scatter of a channel exceeds twice its noise or, for torque and sinkage, kLoudest of
/// its mean.
bool moves(const Estimate& scatter, int channel, double noise_floor) {
  const bool ratio =
      channel == static_cast<int>(Channel::Sinkage) || channel == static_cast<int>(Channel::Torque);
  return scatter.std > 2.0 * noise_floor || (ratio && scatter.std > kLoudest * std::abs(scatter.value));
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
  return fmt::format("{:.2f}", value);
}

/// Returns which median reading no wheel on soil can have; empty if none.
std::string impossible(const Trial& trial) {
  for (const auto& [channel, most] :
       {std::pair{Channel::DrawbarPull, kMostPull}, {Channel::Torque, kMostTorque}})
    if (const double median = medianReading(trial, channel); median > most)
      return std::string("the median of ") + name(channel) + " is " + number(median) +
             ", more than a wheel reaches on soil (" + number(most) +
             "): check the units of the readings and of the wheel";
  return "";
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
  if (const std::string reason = impossible(result.trial); !reason.empty()) return {false, reason, false};
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

namespace {

/// A trial whose measured channels are multiplied by factors, because they are ratios to load and radius.
struct ScaledTrial {
  Trial trial;
  std::array<double, kChannels> factor{1.0, 1.0, 1.0, 1.0};
};

ScaledTrial scaled(const Trial& trial, const std::string& column, double scale) {
  ScaledTrial out{trial};
  const auto set = [&](std::initializer_list<Channel> channels, double factor) {
    for (const Channel c : channels) {
      out.factor[static_cast<std::size_t>(c)] = factor;
      out.trial.measured.col(static_cast<Eigen::Index>(c)) *= factor;
    }
  };
  if (column == "load_N") {
    for (double& load : out.trial.load_N) load *= scale;
    for (WheelState& s : out.trial.states) s.load_N *= scale;
    set({Channel::DrawbarPull, Channel::Torque, Channel::SideForce}, 1.0 / scale);
  } else if (column == "wheel_radius_m") {
    for (WheelState& s : out.trial.states) s.wheel.radius_m *= scale;
    set({Channel::Sinkage, Channel::Torque}, 1.0 / scale);
  } else {
    set({column == "torque_Nm" ? Channel::Torque : Channel::DrawbarPull}, scale);
  }
  return out;
}

/// Logarithm of the density of the readings in the units of the file, for a model that is fitted to `rows`.
double logDensity(const RefinedModel& model, const ScaledTrial& rows, const TraceOptions& options) {
  const TrialFit fit{model, rows.trial, options.fit_soil, [](double) { return true; }};
  double sum = fit.scoreOf(fit.model());
  for (int row = 0; row < rows.trial.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      if (std::isfinite(rows.trial.measured(row, c)))  // (T55)
        sum += std::log(fit.rows().whitening().factor[static_cast<std::size_t>(row)](c, c) *
                        rows.factor[static_cast<std::size_t>(c)]);
  return sum;
}

}  // namespace

std::string ScaledColumn::text() const {
  return fmt::format("{} looks like {}: scale {:.4g} (log-likelihood gain {:.4g})", column, reason, scale,
                     gain);
}

std::optional<ScaledColumn> likelyScale(const TraceResult& result, const RefinedModel& present,
                                        const TraceOptions& options) {
  const Trial as_read = asMeasured(result.trial);
  if (!as_read.moment.empty()) return std::nullopt;
  std::optional<ScaledColumn> best;
  const double now = logDensity(present, {as_read}, options);
  for (ScaledColumn one : {ScaledColumn{"load_N", 9.81, "kilograms"},
                           {"load_N", 0.5, "the load of two wheels"},
                           {"drawbar_pull_N", 9.81, "kilogram-force"},
                           {"drawbar_pull_N", 0.5, "the pull of two wheels"},
                           {"torque_Nm", 9.81, "kilogram-force times metres"},
                           {"torque_Nm", 0.5, "the torque of two wheels"},
                           {"wheel_radius_m", 0.5, "the diameter"}}) {
    if ((one.column == "torque_Nm" && !as_read.has(Channel::Torque)) ||
        (one.column == "drawbar_pull_N" && !as_read.has(Channel::DrawbarPull)))
      continue;
    one.gain = logDensity(result.base, scaled(as_read, one.column, one.scale), options) - now;
    if (one.gain > std::max(result.threshold, best ? best->gain : 0.0)) best = one;
  }
  return best;
}

Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch) {
  constexpr int kFewest = 20, kMost = 400;
  const ModelFile file = baseModel(base, rover);
  const Telemetry telemetry = readTelemetry(table, {});
  const bool wheel =
      file.model.wheel || (telemetry.find("wheel_radius_m") && telemetry.find("wheel_width_m"));
  if (!wheel || !telemetry.find("load_N") || !telemetry.find("slip")) return {};
  if (!telemetry.find("sinkage_m") && !telemetry.find("torque_Nm") && !telemetry.find("drawbar_pull_N"))
    return {};
  const ModelRows rows = modelRows(telemetry, file.model);
  const Trial trial = subset(rows.trial, rowSample(rows.trial, kMost, 1));
  if (const std::string reason = impossible(trial); !reason.empty()) return {false, reason, false};
  if (trial.rows() < kFewest) return {};
  TraceOptions options{.max_effects = 0};
  options.fit_soil = !file.soil_given;
  const Applicability plain = applicability(traceResiduals(rows.model, trial, options), options);
  if (plain.applies || watch.stopped()) return plain;
  options.max_effects = TraceOptions{}.max_effects;
  const Applicability traced = applicability(traceResiduals(rows.model, trial, options, watch), options);
  return watch.stopped() ? Applicability{} : traced;
}

}  // namespace talus::terramech
