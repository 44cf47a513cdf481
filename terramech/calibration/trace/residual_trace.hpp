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

/// Traces the residuals of the model `base` on the rows of `trial`. The result is deterministic for a seed.
/// After a stop by the watch the result contains the effects found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

}  // namespace talus::terramech
