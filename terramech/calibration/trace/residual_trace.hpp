#pragma once

#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

/// From measured rows and a model: what the model lacks, and the model with it.
namespace talus::terramech {

/// Whether the first of explanations, best first, is taken: it gains more than `threshold`.
bool accepted(const std::vector<Explanation>& ranked, double threshold);

/// Brings to the front of explanations, best first, the best of the simplest kind (known forms, of a family the one of fewest numbers, then drifts, then curves)
/// that itself gains more than `threshold` and falls behind the best by less: on top of it noise gives some curve as much,
/// so that a curve is no better account until it gains more than that. What it holds beyond the form is then found by itself.
void preferSimple(std::vector<Explanation>& ranked, double threshold);

/// Traces the residuals of `base` on the rows of `trial`. Deterministic for a seed. A stopped watch ends it
/// early with what was found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
