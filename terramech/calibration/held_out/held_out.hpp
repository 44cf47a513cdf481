#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Errors on held-out rows for one partition; those of the refined model within result.scope.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Holds out whole levels of the column of each found effect, one effect after another.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
