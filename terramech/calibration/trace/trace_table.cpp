#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/calibration/trace/trace_table.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {

Telemetry readTraceTable(const TableFile& file) {
  Telemetry table = readTelemetry(file, {.required = {"load_N", "slip"}});
  leaveOutWithoutSlipAngle(table);
  return table;
}

TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options,
                      const ProgressMonitor& watch) {
  const TraceInput input = traceInput(table, options.base, options.search);
  const ModelRows& rows = input.rows;
  TableTrace trace{.source = table.source,
                   .rejected = rows.rejected,
                   .result = traceResiduals(rows.model, rows.trial, input.options, watch)};
  if (watch.stopped()) return trace;
  trace.held_out = holdOutLevels(trace.result, input.options);
  trace.held_out.insert(trace.held_out.begin(), trace.result.held_out);
  trace.answer = answerOf(trace.result);
  trace.applies = applicability(trace.result, input.options);
  // No effect makes readings possible that no wheel on soil has.
  const TraceResult& r = trace.result;
  if (trace.answer.verdict == Verdict::Unexplained || !trace.applies.applies)
    if (const auto scale = likelyScale(r, trace.applies.possible ? r.refined : r.base, input.options))
      trace.applies = {.applies = false, .reason = scale->text()};
  if (!trace.applies.applies) {
    trace.answer.verdict = Verdict::Unexplained;
    trace.answer.inapplicable = trace.applies.reason;
  }
  trace.beyond_axle = rows.beyond_axle.rows();
  if (trace.beyond_axle > 0) trace.beyond_axle_rmse = rmseOf(trace.result.refined, rows.beyond_axle);
  return trace;
}

std::string TableTrace::modelText() const {
  return terramech::modelText(forPrediction(result), result.scope);
}

}  // namespace talus::terramech
