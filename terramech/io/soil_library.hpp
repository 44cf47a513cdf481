#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {

/// Converts the option --prior of the program to the priors of each estimation method.

/// Loads the soils that the option selects: one soil of the library, or all soils of a file. Returns an empty
/// vector for an empty option. Throws InputError.
std::vector<SoilPrior> soilPriors(const std::string& name_or_path);

/// Returns the soils as equally probable soil classes under a wheel of width_m > 0.
SoilMixture mixtureOf(const std::vector<SoilPrior>& soils, double width_m);

/// Returns the soils as equally probable priors of (c, tan phi).
std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils);

/// Returns the mean shear modulus K [m] of at least one soil.
double meanModulus(const std::vector<SoilPrior>& soils);

}  // namespace talus::terramech
