#pragma once

#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/table/model_rows.hpp>

namespace talus::terramech {

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
