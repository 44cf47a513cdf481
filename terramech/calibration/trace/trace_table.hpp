#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>
#include <talus/terramech/calibration/verdict/verdict.hpp>

/// Residual tracing of a telemetry table: finds the effects that a wheel model lacks, and returns the refined
/// model.
namespace talus::terramech {

/// Options for tracing the residuals of a table.
struct TableTraceOptions {
  ModelFile base = unknownSoil();  ///< model whose residuals are traced; unknownSoil(): the soil is fitted
  TraceOptions search;             ///< options of the search; fit_soil is set according to `base`
};

/// Result of tracing a table.
struct TableTrace {
  std::string source;                 ///< path of the table
  std::vector<RejectedRow> rejected;  ///< rejected rows, with the reason
  TraceResult result;                 ///< effects, refined model and errors
  /// result.held_out, then the errors on held-out levels of each effect's column.
  std::vector<HeldOut> held_out;
  Answer answer;                     ///< conclusion of the trace
  Applicability applies;             ///< conclusion whether the wheel model applies to the table
  int beyond_axle = 0;               ///< number of rows with sinkage >= wheel radius, which were left out
  ChannelErrors beyond_axle_rmse{};  ///< errors of the refined model on the rows left out

  /// Returns the number of rows that were compared with the base model. In a large table, only a part of
  /// these rows is searched.
  int rowsUsed() const { return result.trial.rows() + result.unsearched.rows; }

  /// Returns the refined model as text of a model file for loadModel().
  std::string modelText() const;
};

/// Reads a table for tracing. The columns load_N and slip are required. Rows with a side force but no slip
/// angle are listed in Telemetry::rejected. Throws the exceptions of readTelemetry(), and InputError if no
/// row remains.
Telemetry readTraceTable(const TableFile& file);

/// Traces the residuals of a base model on a table. A specified soil without standard deviations gets default
/// ones, unless the table is a rover's own drive. The result is deterministic for a seed. After a stop by the
/// watch the result contains the effects found so far, without held-out errors, answer and applicability.
/// Throws InputError if too few rows are usable (traceInput()).
TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options = {},
                      const ProgressMonitor& watch = {});

}  // namespace talus::terramech
