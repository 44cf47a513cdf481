#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Returns the errors on held-out rows for one partition. The errors of the refined model are those within
/// result.scope.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Holds out whole levels of the column of each found effect, one effect after another.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
