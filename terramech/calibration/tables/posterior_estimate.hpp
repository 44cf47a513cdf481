#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Estimates the soil by method wong-reece without a model file: the posterior given the equilibrium of the
/// wheel. Throws the exceptions of estimateSoil(), and std::domain_error if no soil explains the rows
/// (noSoilExplains()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
