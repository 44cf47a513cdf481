#pragma once

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Estimates the soil by method wong-reece without a model file: the posterior given the equilibrium of the
/// wheel. Throws the exceptions of estimateSoil(), and std::domain_error if no soil explains the rows
/// (noSoilExplains()).
SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

/// Returns true if a soil estimate from the table requires the complete wheel model. This is the case if a
/// side force is measured in rows with a slip angle above kStraightUpTo_rad, or if the side force in rows of
/// straight wheels exceeds kCoarse of the load (root mean square). Throws the exceptions of readTelemetry().
bool measuresSideForce(const TableFile& table);

/// Estimates the soil by method wong-reece from all channels of the table, with the effects of options.model
/// if given. Throws the exceptions of estimateSoil(). Throws std::domain_error if no soil explains the rows
/// (noSoilExplains()), or if a soil explains all columns except one of at least three (leavesUnexplained()).
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
