#pragma once

#include <array>
#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Values of a column over the rows that a model was fitted to, and how it errs beyond them.
struct TrainedRange {
  std::string column;
  double low = 0.0, high = 0.0;
  /// Growth of the standard deviation of each scaled channel a unit of the column, below low and above high.
  std::array<double, kChannels> below{}, above{};

  /// How far a value lies outside; 0 inside, and where it is NaN.
  double outside(double x) const { return x < low ? low - x : x > high ? x - high : 0.0; }
  double stdAt(double x, std::size_t channel) const {
    return outside(x) * (x < low ? below : above)[channel];
  }
};

/// A model as a file states it.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;             ///< false: the file names no soil, and it has to be fitted from data
  std::vector<TrainedRange> trained;  ///< of the rows that it was fitted to; empty: not known
};

/// Reads a base or refined model:
///   {soil: {...}|NAME, model: wong-reece|linear-formula, sensors: {load_N, slip, torque_Nm, sinkage_m,
///   drawbar_pull_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...], trained: [{column, range:
///    [low, high], below: [4], above: [4]}]}
/// or a bare soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// The list `effects:` of a file, as above; covariate and channel may be left out of a known form, which has
/// its own.
std::vector<Effect> readEffects(const YamlFields& root);

/// The start of a fit when no soil is given.
ModelFile unknownSoil();

/// The text of a file that loadModel() reads back to the same bits.
std::string modelText(const RefinedModel& model, const std::vector<TrainedRange>& trained = {});

}  // namespace talus::terramech
