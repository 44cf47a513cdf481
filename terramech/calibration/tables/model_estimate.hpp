#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Returns true if a side force is measured in rows with a slip angle above kStraightUpTo_rad, or exceeds
/// kCoarse of the load (root mean square) in rows of straight wheels. Such rows require the complete model
/// for a soil estimate. Throws as readTelemetry().
bool measuresSideForce(const TableFile& table);

/// Estimates the soil by --method wong-reece from all channels of the table, with the effects of --model if
/// given. Throws as estimateSoil(), and std::domain_error if no soil explains the rows (noSoilExplains()), or
/// if a soil explains all columns except one of at least three (leavesUnexplained()).
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
