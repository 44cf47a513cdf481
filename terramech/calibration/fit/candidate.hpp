#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/effects/effects.hpp>

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

/// Returns all library effects that the columns of a trial (table of measured rows) permit, each at its
/// typical size. Nonlinear effects are returned with several start values, sensor effects also for single
/// groups of a text column. `sinkage_m` is the model's sinkage in each row.
std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Returns candidate curves of every covariate (numeric column that varies), initially zero: a line, and
/// splines of 4, 7 and 13 knots, each applied to one measured channel, to the soil stiffness or to the soil
/// strength. A column that is constant within runs needs at least three runs per knot. Further candidates are
/// steps of time, heading and additional columns (columns unknown to Talus), a constant per group of a text
/// column, and lines over products "A*B" of an additional column A of the effects `in` (those of the present
/// model) with slip, load, speed or another additional column.
std::vector<Candidate> empiricalCandidates(const Trial& trial, const std::vector<Effect>& in);

/// Returns the candidate of a single library effect.
Candidate formOf(const Effect& effect);

/// Returns true if a covariate is a product "A*B" of two columns.
bool isProduct(const std::string& covariate);

/// Returns true for an additional column: a numeric column that is not one of stateColumns().
bool isOwnColumn(const std::string& column);

/// Returns the value of GainDistribution::further_questions for a search after a screening of columns:
/// ln((kept + dropped) / kept), with the numbers of columns that the screening kept and dropped.
double furtherQuestions(const Trial& trial);

/// Returns the coarsest candidates of an additional column: a spline of 4 knots in each measured channel, one
/// channel at a time. For a text column returns a constant per group.
std::vector<Candidate> coarseCandidates(const Trial& trial, const std::string& column);

}  // namespace talus::terramech
