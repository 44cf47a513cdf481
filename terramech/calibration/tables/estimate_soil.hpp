#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Names of the estimation methods: "bevameter", "sojourner", "iagnemma", "linear-offset", "wong-reece".
const std::vector<std::string>& estimateMethods();

/// Names of the methods for the shear modulus K: "error-minimisation", "effective-torque",
/// "effective-torque-printed", "joint".
const std::vector<std::string>& modulusMethods();

/// Runs the method on the table. Throws InputError for invalid input, std::domain_error if no fit exists.
SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
