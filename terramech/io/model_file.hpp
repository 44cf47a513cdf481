#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {

/// Reads the fields `fitted` and `covariance` of a model file into a model whose effects have been read.
/// Throws InputError if a parameter is unknown or listed twice, or if the matrix is not a covariance.
void readFit(const YamlFields& root, RefinedModel& model);

}  // namespace talus::terramech
