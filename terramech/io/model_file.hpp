#pragma once

#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// A model as a file states it.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;  ///< false: the file names no soil, and it has to be fitted from data
};

/// Reads a base or refined model:
///   {soil: {...}|NAME, model: wong-reece|linear-formula, sensors: {load_N, slip, torque_Nm, sinkage_m,
///   drawbar_pull_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...]}
/// or a bare soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// The list `effects:` of a file, as above; covariate and channel may be left out of a known form, which has
/// its own.
std::vector<Effect> readEffects(const YamlFields& root);

/// The start of a fit when no soil is given.
ModelFile unknownSoil();

/// The text of a file that loadModel() reads back to the same bits.
std::string modelText(const RefinedModel& model);

}  // namespace talus::terramech
