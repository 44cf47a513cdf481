#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// The soil by plate tests: bevameter. Throws as estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
