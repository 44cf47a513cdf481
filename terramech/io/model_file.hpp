#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {

/// Reads the fields `fitted` and `covariance` of a model file into a model whose effects have been read.
/// Throws InputError if a parameter is unknown or listed twice, or if the matrix is not a covariance.
void readFit(const YamlFields& root, RefinedModel& model);

/// Sets the soil of a model and the prior of the soil's parameters.
void setSoil(RefinedModel& model, const SoilPrior& prior);

}  // namespace talus::terramech
