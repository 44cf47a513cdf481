#pragma once

#include <talus/terramech/calibration/table/model_rows.hpp>
#include <talus/terramech/calibration/trace/trace_table.hpp>

namespace talus::terramech {

/// What a table gives traceResiduals().
struct TraceInput {
  ModelRows rows;  ///< rows.model is the base, its soil with default deviations where traceTable() gives them
  TraceOptions options;
};

/// Throws InputError as traceTable().
TraceInput traceInput(const Telemetry& table, const TableTraceOptions& options);

}  // namespace talus::terramech
