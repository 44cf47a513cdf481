#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Posterior of the soil from the wheel's equilibrium: wong-reece without a model. Throws as estimateSoil(),
/// and std::domain_error if no soil explains the rows (noSoilExplains()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
