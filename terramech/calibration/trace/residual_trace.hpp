#pragma once

#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>

namespace talus::terramech {

/// Residual tracing: finds the effects that a wheel model lacks from measured rows, and adds them to the
/// model.

/// Returns true if the first of the ranked explanations (fitted candidate effects) is accepted, i.e. if its
/// gain exceeds `threshold`.
bool accepted(const std::vector<Explanation>& ranked, double threshold);

/// Traces the residuals of the model `base` on the rows of `trial`. The result is deterministic for a seed.
/// After a stop by the watch the result contains the effects found so far.
TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options = {},
                           const ProgressMonitor& watch = {});

/// Input of traceResiduals(), prepared from a table.
struct TraceInput {
  ModelRows rows;  ///< rows, and rows.model as base model
  TraceOptions options;
};

/// Prepares rows and base model of a trace. The soil is fitted if the base model specifies no soil. A
/// specified soil without standard deviations gets the default ones of giveDefaultDeviations(), unless the
/// table is a rover's own drive. Throws the exceptions of modelRows(), and InputError if fewer than 5 rows
/// are usable.
TraceInput traceInput(const Telemetry& table, const ModelFile& base, const TraceOptions& options);

}  // namespace talus::terramech
