#pragma once

#include <string>
#include <utility>
#include <vector>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// Column that a formula lacks; the term is slope times column.
struct FormulaEffect {
  std::string column;
  Estimate slope;
  double gain = 0.0;               ///< log-evidence over the formula with the other effects
  double p_value = 1.0;            ///< share of tables without the effect in which some column gains as much
  std::vector<std::string> equal;  ///< columns whose gain in place of the effect is lower by at most 3
};

/// Result of tracing the residual of a formula. Errors are in the unit of the answer column.
struct FormulaTrace {
  std::string answer;                                          ///< column that the formula describes
  std::vector<std::pair<std::string, Estimate>> parameters{};  ///< of the formula, fitted with the effects
  std::vector<FormulaEffect> effects{};                        ///< found effects, in the order of acceptance
  std::vector<FormulaEffect>
      rejected{};        ///< other columns, with the gain over the refined formula, best first
  std::string scheme{};  ///< rows that are held out together
  double mean = 0.0;     ///< mean of the answer
  double base_rmse = 0.0, refined_rmse = 0.0;  ///< errors on the fitted rows
  double base_held = 0.0, refined_held = 0.0;  ///< errors on held-out rows; the effects were chosen on all
  double noise_floor = 0.0;  ///< scatter of single rows within runs; NaN if each run is one row
  Verdict verdict = Verdict::NothingMissing;
};

/// Traces the residual of a formula "answer = expression" over the columns of a table. The expression contains
/// numbers, columns, + - * / ^ and parentheses, and is linear in its parameters, which are all other names. A table
/// without the answer column, of runs over time_s, becomes one row for each run with distance_m, height_m (z_m, else
/// pitch_rad), turning_rad (sum of changes of heading_rad), cross_slope_m (integral of |sin(roll_rad)| over the
/// distance), time_s, and integrals over time of the columns that Talus does not know and of speed_mps: charge_As of
/// NAME_A, energy_J of NAME_W, otherwise NAME_s. The other columns, and each value of a text column, are candidates.
///
/// The rows of a run share a normal error, whose ratio to that of single rows is estimated under each candidate. The
/// parameters of the formula have a uniform prior, a slope has the g-prior of Zellner with g = runs. A candidate is
/// accepted if its log-evidence exceeds the greatest gain in all but a share `significance` of tables drawn without
/// it (exact for normal errors), and exchanged while another gains more. Throws InputError if the formula is not
/// linear, or if the rows do not determine its parameters.
FormulaTrace traceFormula(const Telemetry& table, const std::string& formula,
                          const TraceOptions& options = {});

}  // namespace talus::terramech
