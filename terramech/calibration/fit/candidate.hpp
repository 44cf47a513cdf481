#pragma once

#include <string>
#include <vector>

#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Candidate: a possible addition to a wheel model. A candidate is an effect of the library, or a set of
/// curves of one covariate (telemetry column), one curve for each of some channels.
struct Candidate {
  std::vector<Effect> parts;  ///< one effect, or one curve per channel
  std::string family;         ///< family of the effect; "empirical" for curves
  int parameters = 0;         ///< number of fitted parameters

  /// Returns the logarithm of the prior probability of the candidate as a cause, relative to a known form of
  /// one parameter: ln(1/20)/4 for each further parameter of a form, ln(1/20)/2 for a drift, ln(1/20) for a
  /// curve, which includes a drift, and 3 ln(1/20)/2 for a product of two columns (ours).
  double logPrior() const;

  /// Returns true if the candidate consists of curves.
  bool empirical() const { return parts.front().empirical(); }
  /// Returns the telemetry column that explains the residual. For an effect on one group of rows, this is the
  /// text column of the group.
  const std::string& covariate() const {
    const Effect& front = parts.front();
    return front.only_column.empty() ? front.covariate : front.only_column;
  }
};

}  // namespace talus::terramech
