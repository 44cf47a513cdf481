#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Estimates the soil from plate tests by method bevameter. Throws the exceptions of estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
