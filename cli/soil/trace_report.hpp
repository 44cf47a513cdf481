#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/trace_table.hpp>

namespace talus::cli {

/// Columns that move with a covariate so closely (|correlation| above 0.9) that the rows cannot tell them
/// apart.
std::vector<std::string> confounded(const terramech::Trial& trial, const std::string& covariate);

/// The column that explains an effect: of one on a single group of rows, the column of the group.
const std::string& covariateOf(const terramech::Effect& effect);

/// A fitted parameter of an effect.
struct FittedNumber {
  std::string name, unit;  ///< unit "-": dimensionless
  double value = 0.0, std = 0.0;
  bool at_bound = false;  ///< at a bound of its range
};

/// The fitted parameters of an effect of known form, in its order; empty for a curve.
std::vector<FittedNumber> fittedNumbers(const terramech::TracedEffect& effect);

/// A p-value as text: below 0.001, and below what the drawn tables can tell, as a bound.
std::string pText(double p);

/// One line about the other causes that the rows cannot separate from an effect; there must be some.
std::string equalText(const terramech::TracedEffect& effect);

/// The measurement that would discriminate between an effect and its closest alternative.
std::string separatingMeasurement(const terramech::Trial& trial, const terramech::TracedEffect& effect);

/// One line about the rows left out because the wheel is sunk to its axle; there must be some.
std::string beyondAxleText(const terramech::TableTrace& trace);

/// One line about a parameter of the soil far from its prior.
std::string movedText(const terramech::MovedParameter& parameter);

nlohmann::ordered_json traceJson(const terramech::TableTrace& trace);
std::string traceText(const terramech::TableTrace& trace);
std::string tracePage(const terramech::TableTrace& trace);

}  // namespace talus::cli
