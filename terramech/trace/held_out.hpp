#pragma once

#include <string>
#include <vector>

#include <talus/terramech/trace/folds.hpp>
#include <talus/terramech/trace/trace_result.hpp>

namespace talus::terramech {

/// The base of a result fitted again to the rows that `train` marks, as it was fitted to all of them: by rowsOfSoil() and
/// what rows share beside the base.
RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train);

/// Its refined model fitted again to those rows.
RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train);

/// Errors at the slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial);

/// Errors under one way to hold rows out, the refined model's within result.scope.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Whole levels of the column of each effect that was found, in turn.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
