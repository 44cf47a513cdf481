#pragma once

#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Returns the names of the soil-estimation methods: "bevameter", "sojourner", "iagnemma", "linear-offset",
/// "wong-reece".
const std::vector<std::string>& estimateMethods();

/// Returns the names of the methods for the shear modulus K: "error-minimisation", "effective-torque",
/// "effective-torque-printed", "joint".
const std::vector<std::string>& modulusMethods();

/// Estimates the soil from a table by options.method. Throws InputError for invalid input and
/// std::domain_error if no fit exists.
SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
