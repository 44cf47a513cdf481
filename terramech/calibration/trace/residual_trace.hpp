#pragma once

#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

/// Finds the effects missing in a model from measured rows, and makes the refined model.
namespace talus::terramech {

/// Returns true if the first of the ranked explanations is accepted, which requires a gain above `threshold`.
bool accepted(const std::vector<Explanation>& ranked, double threshold);

/// Moves the best explanation of the simplest kind to the front of the ranked explanations, if its gain
/// exceeds `threshold` and is less than `threshold` below the best gain. Kinds in order: known forms (within
/// a family, the form with the fewest parameters), drifts, curves. With noise alone the gain of some curve is
/// higher by up to `threshold`; a curve is therefore preferred only for a greater gain. Later steps find
/// remaining contributions of the curve.
void preferSimple(std::vector<Explanation>& ranked, double threshold);

/// Traces the residuals of `base` on the rows of `trial`. Deterministic for a seed. After a stop by the watch
/// the result contains the effects found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
