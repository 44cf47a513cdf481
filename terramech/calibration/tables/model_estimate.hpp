#pragma once

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/tables/soil_estimate.hpp>

namespace talus::terramech {

/// Whether some row of a wheel at a slip angle (beyond kStraightUpTo_rad) has its side force, or straight wheels have one of more
/// than kCoarse of the load (root mean square): what such rows say of the soil takes the whole model. Throws as readTelemetry().
bool measuresSideForce(const TableFile& table);

/// The soil by --method wong-reece from all channels that the table has, the effects of --model acting; without one none
/// act. Throws as estimateSoil(); std::domain_error where no soil comes near the rows (noSoilExplains()), or where a soil explains all columns but one of three or
/// more, and leaves that one unexplained (leavesUnexplained()).
SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
