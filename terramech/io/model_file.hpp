#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Larger than any value of a column, within the range of a model file.
inline constexpr double kUnlimited = 1e12;

/// Range of a column in the rows that a model was fitted to, and the model's error outside the range.
struct TrainedRange {
  std::string column;
  double low = 0.0, high = 0.0;
  /// Increase of the standard deviation of each scaled channel per unit of the column, below low and above
  /// high.
  std::array<double, kChannels> below{}, above{};
  /// Distance below low and above high up to which held-out rows confirmed the corrections of each channel.
  std::array<double, kChannels> reach_below = allChannels(kUnlimited), reach_above = reach_below;

  static constexpr std::array<double, kChannels> allChannels(double value) {
    return {value, value, value, value};
  }

  /// Returns the distance of a value from the range; 0 inside and for NaN.
  double outside(double x) const { return x < low ? low - x : x > high ? x - high : 0.0; }
  double stdAt(double x, std::size_t channel) const {
    return outside(x) * (x < low ? below : above)[channel];
  }

  /// Returns the fraction of a channel's corrections to apply at a value: 1 up to the confirmed distance,
  /// then linearly falling to 0 at twice that distance (ours).
  double share(double x, std::size_t channel) const {
    const double distance = outside(x), reach = (x < low ? reach_below : reach_above)[channel];
    return !(distance > 0.0) ? 1.0 : reach > 0.0 ? std::clamp(2.0 - distance / reach, 0.0, 1.0) : 0.0;
  }
};

/// Range in which the corrections of a refined model are applied.
struct ModelScope {
  std::vector<TrainedRange> trained;  ///< ranges of the rows of the fit; empty: unknown
  std::optional<RefinedModel> base;   ///< model without corrections; nullopt: the model has no corrections
  /// Channels whose corrections held-out rows confirmed.
  std::array<bool, kChannels> kept{true, true, true, true};

  /// Returns the fraction of a channel's corrections to apply to a row, in [0, 1]; the base model has weight
  /// 1 - share.
  double share(const WheelState& state, std::size_t channel) const {
    double least = !base || kept[channel] ? 1.0 : 0.0;
    for (const TrainedRange& range : trained)
      if (base) least = std::min(least, range.share(state.covariate(range.column), channel));
    return least;
  }
};

/// Content of a model file.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;  ///< false: the file has no soil, which must be fitted
  ModelScope scope;
};

/// Reads a base or refined model:
///   {name: ..., soil: {...}|NAME, model: wong-reece|linear-formula, gravity_m_s2: 9.80665,
///    sensors: {load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...], trained: [{column,
///    range: [low, high], below: [4], above: [4], reach_below: [4], reach_above: [4]}], base: {soil, effects,
///    kept: [4]}}
/// or a bare soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// Reads the list `effects:` of a file, as above. Covariate and channel of a library form are optional, with
/// the form's as default.
std::vector<Effect> readEffects(const YamlFields& root);

/// Returns a model without a soil, with the initial soil of a fit.
ModelFile unknownSoil();

/// Returns the text of a model file. loadModel() restores the written numbers bit by bit; numbers too small
/// for a file become 0. Priors of the soil, `stated` and Soil::test_gravity_m_s2 are not written.
std::string modelText(const RefinedModel& model, const ModelScope& scope = {});

}  // namespace talus::terramech
