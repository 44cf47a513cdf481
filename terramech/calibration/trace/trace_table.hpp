#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>
#include <talus/terramech/calibration/verdict/verdict.hpp>

/// Residual tracing of a whole table, from its rows to the refined model.
namespace talus::terramech {

/// Options for tracing the residuals of a table.
struct TableTraceOptions {
  ModelFile base = unknownSoil();  ///< model whose residuals are traced; unknownSoil(): its soil is fitted
  TraceOptions search;             ///< fit_soil follows from the base
};

/// Result of tracing a table.
struct TableTrace {
  std::string source;                 ///< path of the file
  std::vector<RejectedRow> rejected;  ///< rejected rows with the reason
  TraceResult result;                 ///< effects, refined model and errors
  std::vector<HeldOut> held_out;      ///< result.held_out, then held-out levels of the column of each effect
  Answer answer;                      ///< conclusion
  Applicability applies;              ///< applicability of the model
  int beyond_axle = 0;                ///< number of rows with z >= r, which were left out
  ChannelErrors beyond_axle_rmse{};   ///< errors of the refined model on those rows

  /// Number of rows compared with the base model; exceeds the number of searched rows for a large table.
  int rowsUsed() const { return result.trial.rows() + result.unsearched.rows; }

  /// Text of the refined model as a file for loadModel().
  std::string modelText() const;
};

/// Reads a table for tracing; columns load_N and slip are required. Rows with a side force but no slip angle
/// are listed in Telemetry::rejected. Throws InputError as readTelemetry(), and if no row remains.
Telemetry readTraceTable(const TableFile& file);

/// Traces the residuals of a base model on a table. A specified soil without standard deviations gets default
/// ones unless the table is a rover's own drive. Deterministic for a seed. After a stop by the watch the
/// result contains the effects found so far, without held-out errors, answer and applicability. Throws
/// InputError if too few rows are usable (traceInput()).
TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options = {},
                      const ProgressMonitor& watch = {});

}  // namespace talus::terramech
