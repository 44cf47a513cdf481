#pragma once

#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

/// Residual tracing: finds the effects that a wheel model lacks from measured rows, and adds them to the
/// model.
namespace talus::terramech {

/// Returns true if the first of the ranked explanations (fitted candidate effects) is accepted, i.e. if its
/// gain exceeds `threshold`.
bool accepted(const std::vector<Explanation>& ranked, double threshold);

/// Moves the best explanation of the simplest kind to the front of the ranked explanations, if its gain
/// exceeds `threshold` and is less than `threshold` below the best gain. The kinds, from the simplest, are
/// known forms (within a family, the form with the fewest parameters), drifts, and curves. With noise alone
/// the gain of some curve is higher by up to `threshold`; a curve is therefore preferred only for a greater
/// gain. If the curve explains more, later steps find the remainder.
void preferSimple(std::vector<Explanation>& ranked, double threshold);

/// Traces the residuals of the model `base` on the rows of `trial`. The result is deterministic for a seed.
/// After a stop by the watch the result contains the effects found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
