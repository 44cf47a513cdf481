#pragma once

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Estimates the soil from plate tests by method bevameter. Throws the exceptions of estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Estimates the soil by one of the linear methods sojourner, iagnemma and linear-offset. Throws the
/// exceptions of estimateSoil().
SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
