#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/estimate/model_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {

/// Number of a soil that a file may state with a standard deviation.
struct SoilField {
  const char* name;  ///< key in files
  double Soil::*value;
  double SoilDeviation::*deviation;
  bool required = false;  ///< false: the default is that of Soil
};

/// Returns all numbers of a soil except test_gravity_m_s2 and correlation_time_s.
std::span<const SoilField> soilFields();

/// Converts the option --prior of the program to the priors of each estimation method.

/// Loads the soils that the option selects: one soil of the library, or all soils of a file. Returns an empty
/// vector for an empty option. Throws InputError.
std::vector<SoilPrior> soilPriors(const std::string& name_or_path);

/// Returns the soils as equally probable priors of (c, tan phi).
std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils);

/// Returns the mean shear modulus K [m] of at least one soil.
double meanModulus(const std::vector<SoilPrior>& soils);

}  // namespace talus::terramech
