#pragma once

#include <talus/talus.hpp>
#include <talus/terramech/trace/trace_result.hpp>

/// From measured rows and a model: what the model lacks, and the model with it.
namespace talus::terramech {

/// Traces the residuals of `base` on the rows of `trial`. Deterministic for a seed. A stopped watch ends it
/// early with what was found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
