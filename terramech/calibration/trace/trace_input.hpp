#pragma once

#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/table/model_rows.hpp>

namespace talus::terramech {

/// What a table gives traceResiduals().
struct TraceInput {
  ModelRows rows;  ///< rows.model is the base
  TraceOptions options;
};

/// The rows and the base of a search. A soil that the base does not give is fitted. A given soil without standard deviations
/// gets default ones (giveDefaultDeviations()) unless the table is a rover's own drive. Throws InputError as modelRows(), and when fewer than 6 rows can be used.
TraceInput traceInput(const Telemetry& table, const ModelFile& base, const TraceOptions& options);

}  // namespace talus::terramech
