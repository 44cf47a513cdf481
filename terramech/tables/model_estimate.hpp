#pragma once

#include <talus/terramech/tables/soil_estimate.hpp>

namespace talus::terramech {

/// The soil by --method wong-reece with the effects of --model acting, from all channels that the table has.
/// Throws as estimateSoil().
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
