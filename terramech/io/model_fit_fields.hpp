#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {

/// Reads `fitted` and `covariance` of a model file into a model whose effects are known. Throws InputError when a parameter is
/// unknown or named twice, or the numbers are no covariance.
void readFit(const YamlFields& root, RefinedModel& model);

}  // namespace talus::terramech
