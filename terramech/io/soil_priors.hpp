#pragma once

#include <string>
#include <vector>

#include <talus/terramech/estimate/soil_mixture.hpp>
#include <talus/terramech/estimate/strength_prior.hpp>

/// What --prior names, as each method takes it.
namespace talus::terramech {

/// A soil of the library, or the soils of a file; none where the option is empty. Throws InputError.
std::vector<SoilPrior> soilPriors(const std::string& name_or_path);

/// As classes of soil under a wheel of that width [m], each as likely.
SoilMixture mixtureOf(const std::vector<SoilPrior>& soils, double width_m);

/// As (c, tan phi) alone, each as likely.
std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils);

/// Mean shear modulus K over the soils [m]; there must be one.
double meanModulus(const std::vector<SoilPrior>& soils);

}  // namespace talus::terramech
