#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/trace_table.hpp>

namespace talus::cli {

/// Columns correlated so strongly with a covariate (|correlation| > 0.9) that the rows cannot discriminate
/// between them.
std::vector<std::string> confounded(const terramech::Trial& trial, const std::string& covariate);

/// Column that explains an effect; for an effect on a single group of rows, the column of the group.
const std::string& covariateOf(const terramech::Effect& effect);

/// A fitted parameter of an effect.
struct FittedNumber {
  std::string name, unit;  ///< unit "-": dimensionless
  double value = 0.0, std = 0.0;
  bool at_bound = false;  ///< at a bound of its range
};

/// The fitted parameters of an effect of known form, in the form's order; empty for a curve.
std::vector<FittedNumber> fittedNumbers(const terramech::TracedEffect& effect);

/// A p-value as text; as an upper bound if below 0.001 or below the resolution of the drawn tables.
std::string pText(double p);

/// Returns one line about the other causes that the rows cannot separate from an effect; requires at least
/// one such cause.
std::string equalText(const terramech::TracedEffect& effect);

/// The measurement that would discriminate between an effect and its closest alternative.
std::string separatingMeasurement(const terramech::Trial& trial, const terramech::TracedEffect& effect);

/// Returns one line about rows left out because the wheel is sunk to its axle; requires at least one such
/// row.
std::string beyondAxleText(const terramech::TableTrace& trace);

/// Returns one line about a soil parameter far from its prior.
std::string movedText(const terramech::MovedParameter& parameter);

nlohmann::ordered_json traceJson(const terramech::TableTrace& trace);
std::string traceText(const terramech::TableTrace& trace);
std::string tracePage(const terramech::TableTrace& trace);

}  // namespace talus::cli
