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

/// How the residuals of a table are traced.
struct TableTraceOptions {
  ModelFile base = unknownSoil();  ///< model whose residuals are traced; unknownSoil(): its soil is fitted
  TraceOptions search;             ///< fit_soil follows from the base
};

/// What a table shows of a model.
struct TableTrace {
  std::string source;                 ///< the file
  std::vector<RejectedRow> rejected;  ///< rows that were left out, each with its reason
  TraceResult result;
  std::vector<HeldOut> held_out;  ///< result.held_out, then whole levels of the column of each effect
  Answer answer;
  Applicability applies;
  int beyond_axle = 0;               ///< rows left out because the wheel is sunk to its axle or deeper
  ChannelErrors beyond_axle_rmse{};  ///< of the refined model on those rows

  /// Rows that the base was compared with, in a large table more than were searched.
  int rowsUsed() const { return result.trial.rows() + result.unsearched.rows; }

  /// The refined model as a file that loadModel() reads.
  std::string modelText() const;
};

/// Reads a table for tracing: columns load_N and slip are required. Rows with a side force and no slip angle are left out
/// and named in Telemetry::rejected. Throws InputError as readTelemetry(), and when no row is left.
Telemetry readTraceTable(const TableFile& file);

/// Traces the residuals of a base model on a table. A given soil without standard deviations gets default ones unless the table
/// is a rover's own drive. Deterministic for a seed. A stopped watch ends the search early with what was found so far, without
/// held-out errors, answer and applicability. Throws InputError when fewer than 5 rows can be used.
TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options = {},
                      const ProgressMonitor& watch = {});

}  // namespace talus::terramech
