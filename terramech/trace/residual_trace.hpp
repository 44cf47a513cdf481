#pragma once

#include <vector>

#include <talus/talus.hpp>
#include <talus/terramech/trace/trace_result.hpp>

/// From measured rows and a model: what the model lacks, and the model with it.
namespace talus::terramech {

/// Whether the first of explanations, best first, is taken: it gains more than `threshold`. Curves and known forms are
/// ranked by the one gain, so that a name is given only where its form beats every curve.
bool accepted(const std::vector<Explanation>& ranked, double threshold);

/// Traces the residuals of `base` on the rows of `trial`. Deterministic for a seed. A stopped watch ends it
/// early with what was found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
