#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Beyond any column, within what a model file may hold.
inline constexpr double kUnlimited = 1e12;

/// Values of a column over the rows that a model was fitted to, and how it errs beyond them.
struct TrainedRange {
  std::string column;
  double low = 0.0, high = 0.0;
  /// Growth of the standard deviation of each scaled channel a unit of the column, below low and above high.
  std::array<double, kChannels> below{}, above{};
  /// Distance below low and above high to which held-out rows confirmed the corrections of a channel.
  std::array<double, kChannels> reach_below = allChannels(kUnlimited), reach_above = reach_below;

  static constexpr std::array<double, kChannels> allChannels(double value) {
    return {value, value, value, value};
  }

  /// How far a value lies outside; 0 inside, and where it is NaN.
  double outside(double x) const { return x < low ? low - x : x > high ? x - high : 0.0; }
  double stdAt(double x, std::size_t channel) const {
    return outside(x) * (x < low ? below : above)[channel];
  }

  /// Share of a channel's corrections that is applied at a value: all as far as held-out rows confirmed them, then in
  /// proportion less, none twice as far (ours).
  double share(double x, std::size_t channel) const {
    const double distance = outside(x), reach = (x < low ? reach_below : reach_above)[channel];
    return !(distance > 0.0) ? 1.0 : reach > 0.0 ? std::clamp(2.0 - distance / reach, 0.0, 1.0) : 0.0;
  }
};

/// Where the corrections of a refined model are applied.
struct ModelScope {
  std::vector<TrainedRange> trained;  ///< of the rows that it was fitted to; empty: not known
  std::optional<RefinedModel>
      base;  ///< soil and effects without corrections; empty: there are none to take back
  std::array<bool, kChannels> kept{true, true, true, true};  ///< channels that held-out rows confirmed

  /// Share of a channel's corrections, [0, 1], that a row gets; 1 - share stays the base's.
  double share(const WheelState& state, std::size_t channel) const {
    double least = !base || kept[channel] ? 1.0 : 0.0;
    for (const TrainedRange& range : trained)
      if (base) least = std::min(least, range.share(state.covariate(range.column), channel));
    return least;
  }
};

/// A model as a file states it.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;  ///< false: the file names no soil, and it has to be fitted from data
  ModelScope scope;
};

/// Reads a base or refined model:
///   {soil: {...}|NAME, model: wong-reece|linear-formula, sensors: {load_N, slip, torque_Nm, sinkage_m,
///   drawbar_pull_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...], trained: [{column, range:
///    [low, high], below: [4], above: [4], reach_below: [4], reach_above: [4]}], base: {soil, effects, kept: [4]}}
/// or a bare soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// The list `effects:` of a file, as above; covariate and channel may be left out of a known form, which has
/// its own.
std::vector<Effect> readEffects(const YamlFields& root);

/// The start of a fit when no soil is given.
ModelFile unknownSoil();

/// The text of a file that loadModel() reads back to the same bits.
std::string modelText(const RefinedModel& model, const ModelScope& scope = {});

}  // namespace talus::terramech
