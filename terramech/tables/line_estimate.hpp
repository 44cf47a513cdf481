#pragma once

#include <talus/terramech/tables/soil_estimate.hpp>

namespace talus::terramech {

/// The linear methods: sojourner, iagnemma, linear-offset. Throws as estimateSoil().
SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
