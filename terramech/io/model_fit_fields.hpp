#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {

/// Reads `fitted` and `covariance` of a model file into a model with known effects. Throws InputError if a
/// parameter is unknown or listed twice, or if the matrix is not a covariance.
void readFit(const YamlFields& root, RefinedModel& model);

}  // namespace talus::terramech
