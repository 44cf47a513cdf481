#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Distance without limit: larger than any value of a column, but in the range of numbers in a model file.
inline constexpr double kUnlimited = 1e12;

/// Range of a telemetry column in the rows to which a model was fitted, and the model's behaviour outside
/// this range. Corrections are the effects by which a refined model differs from its base model.
struct TrainedRange {
  std::string column;  ///< name of the column
  /// Least and greatest value of the column in these rows.
  double low = 0.0, high = 0.0;
  /// Standard deviation that is added to each scaled channel, per unit of distance below `low` and above
  /// `high`.
  std::array<double, kChannels> below{}, above{};
  /// Distances below `low` and above `high` up to which the corrections of each channel are applied in full,
  /// because no held-out rows contradict the corrections there.
  std::array<double, kChannels> reach_below = allChannels(kUnlimited), reach_above = reach_below;

  static constexpr std::array<double, kChannels> allChannels(double value) {
    return {value, value, value, value};
  }

  /// Returns the distance of a value from the range; 0 inside the range and for NaN.
  double outside(double x) const { return x < low ? low - x : x > high ? x - high : 0.0; }
  /// Returns the standard deviation that is added to a scaled channel at a value of the column [-].
  double stdAt(double x, std::size_t channel) const {
    return outside(x) * (x < low ? below : above)[channel];
  }

  /// Returns the fraction of a channel's corrections to apply at a value of the column: 1 up to the distance
  /// `reach`, then falling linearly to 0 at twice this distance (ours).
  double share(double x, std::size_t channel) const {
    const double distance = outside(x), reach = (x < low ? reach_below : reach_above)[channel];
    return !(distance > 0.0) ? 1.0 : reach > 0.0 ? std::clamp(2.0 - distance / reach, 0.0, 1.0) : 0.0;
  }
};

/// Channels and ranges of columns in which the corrections of a refined model are applied.
struct ModelScope {
  std::vector<TrainedRange> trained;  ///< ranges of the columns in the fitted rows; empty: unknown
  std::optional<RefinedModel> base;   ///< model without corrections; nullopt: no corrections exist
  /// True for channels in which held-out rows confirmed the corrections.
  std::array<bool, kChannels> kept{true, true, true, true};

  /// Returns the fraction of a channel's corrections to apply to a row, in [0, 1]. The prediction of the base
  /// model has the weight 1 - share.
  double share(const WheelState& state, std::size_t channel) const {
    double least = !base || kept[channel] ? 1.0 : 0.0;
    for (const TrainedRange& range : trained)
      if (base) least = std::min(least, range.share(state.covariate(range.column), channel));
    return least;
  }
};

/// Contents of a model file.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;  ///< false: the file contains no soil, so the soil must be fitted
  ModelScope scope;        ///< channels and ranges in which the corrections are applied
};

/// Reads a base or refined model from a YAML file of the form
///   {name: ..., soil: {...}|NAME, model: wong-reece|linear-formula, gravity_m_s2: 9.80665,
///    sensors: {load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...], trained: [{column,
///    range: [low, high], below: [4], above: [4], reach_below: [4], reach_above: [4]}], base: {soil, effects,
///    kept: [4]}}
/// or a file that contains only a soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// Reads the list `effects:` of a model file, in the form above. If covariate and channel of a library form
/// are missing, the values of the form are used.
std::vector<Effect> readEffects(const YamlFields& root);

/// Returns a model whose soil must be fitted, with the initial soil of the fit.
ModelFile unknownSoil();

/// Returns the text of a model file. loadModel() restores bit-identical numbers, except that numbers too
/// small for a file become 0. Priors of the soil, RefinedModel::stated and Soil::test_gravity_m_s2 are not
/// written.
std::string modelText(const RefinedModel& model, const ModelScope& scope = {});

}  // namespace talus::terramech
