#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <talus/terramech/calibration/search/scale_hypotheses.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>

namespace talus::terramech {
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
      if (std::isfinite(rows.trial.measured(row, c)))  // (T58)
        sum += std::log(fit.rows().whitening().factor[static_cast<std::size_t>(row)](c, c) *
                        rows.factor[static_cast<std::size_t>(c)]);
  return sum;
}

}  // namespace

std::string ScaledColumn::text() const {
  std::ostringstream out;
  out.precision(4);
  out << column << " looks like " << reason << ": scale " << scale << " (log-likelihood gain " << gain << ')';
  return out.str();
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

}  // namespace talus::terramech
