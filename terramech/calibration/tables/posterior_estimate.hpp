#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// The posterior of the soil by the wheel's equilibrium: wong-reece without a model. Throws as estimateSoil();
/// std::domain_error where no soil comes near the rows (noSoilExplains()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
