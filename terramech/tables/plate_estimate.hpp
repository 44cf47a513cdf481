#pragma once

#include <talus/terramech/tables/soil_estimate.hpp>

namespace talus::terramech {

/// The soil by plate tests: bevameter. Throws as estimateSoil().
SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
