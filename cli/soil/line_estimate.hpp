#pragma once

#include <talus/cli/soil/soil_estimate.hpp>

namespace talus::cli {

/// The linear methods: sojourner, iagnemma, linear-offset. Throws as estimateSoil().
SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// --shear-modulus as a number [m], if it is one.
std::optional<double> statedModulus(const EstimateOptions& options);

}  // namespace talus::cli
