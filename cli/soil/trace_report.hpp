#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/trace_table.hpp>

namespace talus::cli {

/// Returns the columns that are correlated so strongly with the column `covariate` (|correlation| > 0.9) that
/// the rows cannot discriminate between them.
std::vector<std::string> confounded(const terramech::Trial& trial, const std::string& covariate);

/// Returns the column over which an effect varies; for an effect on a single group of rows, the column of the
/// group.
const std::string& covariateOf(const terramech::Effect& effect);

/// A fitted parameter of an effect.
struct FittedNumber {
  std::string name, unit;  ///< name and unit of the parameter; unit "-": dimensionless
  double value = 0.0, std = 0.0;
  bool at_bound = false;  ///< true if the value is at a bound of the parameter's range
};

/// Returns the fitted parameters of an effect of known form, in the order of the form; empty for a curve.
std::vector<FittedNumber> fittedNumbers(const terramech::TracedEffect& effect);

/// Returns a p-value as text; an upper bound if it is below 0.001 or below the resolution of the drawn
/// tables.
std::string pText(double p);

/// Returns one line of text about the other causes that the rows cannot separate from an effect; requires at
/// least one such cause.
std::string equalText(const terramech::TracedEffect& effect);

/// Returns the measurement that would discriminate between an effect and its closest alternative.
std::string separatingMeasurement(const terramech::Trial& trial, const terramech::TracedEffect& effect);

/// Returns one line of text about rows that were left out because the wheel is sunk to its axle; requires at
/// least one such row.
std::string beyondAxleText(const terramech::TableTrace& trace);

/// Returns one line of text about a soil parameter far from its prior.
std::string movedText(const terramech::MovedParameter& parameter);

/// Return the whole analysis of a table as JSON, as text, and as an HTML page.
nlohmann::ordered_json traceJson(const terramech::TableTrace& trace);
std::string traceText(const terramech::TableTrace& trace);
std::string tracePage(const terramech::TableTrace& trace);

}  // namespace talus::cli
