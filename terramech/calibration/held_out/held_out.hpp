#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Returns the errors on held-out rows for one partition of the rows. The errors of the refined model are
/// those within result.scope (channels and ranges in which its effects are applied).
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Returns the errors on held-out levels (rows with the same value of a column), for the column of each found
/// effect.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
