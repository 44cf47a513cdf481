#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Errors under one way to hold rows out, the refined model's within result.scope.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Whole levels of the column of each effect that was found, in turn.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
