#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/strength_prior.hpp>

/// Conversion of option --prior to the priors of each method.
namespace talus::terramech {

/// Returns a soil of the library, or the soils of a file; empty for an empty option. Throws InputError.
std::vector<SoilPrior> soilPriors(const std::string& name_or_path);

/// Returns the soils as equally likely classes for a wheel of width_m > 0 [m].
SoilMixture mixtureOf(const std::vector<SoilPrior>& soils, double width_m);

/// Returns the soils as equally likely priors of (c, tan phi).
std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils);

/// Returns the mean shear modulus K [m] of the soils, of which there must be at least one.
double meanModulus(const std::vector<SoilPrior>& soils);

}  // namespace talus::terramech
