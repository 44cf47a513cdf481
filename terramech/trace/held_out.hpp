#pragma once

#include <string>
#include <vector>

#include <talus/terramech/trace/folds.hpp>
#include <talus/terramech/trace/trace_result.hpp>

namespace talus::terramech {

/// A model of a result fitted again to the rows that `train` marks.
RefinedModel refitted(const RefinedModel& model, const TraceResult& result, const TraceOptions& options,
                      const std::vector<char>& train);

/// Errors at the slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, Trial trial);

/// Errors under one way to hold rows out, the refined model's within result.scope.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Whole levels of the column of each effect that was found, in turn.
std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
