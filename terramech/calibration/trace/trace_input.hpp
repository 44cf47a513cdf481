#pragma once

#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/table/model_rows.hpp>

namespace talus::terramech {

/// Input of traceResiduals() from a table.
struct TraceInput {
  ModelRows rows;  ///< rows.model is the base
  TraceOptions options;
};

/// Rows and base model of a search. The soil is fitted if the base specifies none. A specified soil without
/// standard deviations gets default ones (giveDefaultDeviations()) unless the table is a rover's own drive.
/// Throws InputError as modelRows(), and if fewer than 5 rows are usable.
TraceInput traceInput(const Telemetry& table, const ModelFile& base, const TraceOptions& options);

}  // namespace talus::terramech
