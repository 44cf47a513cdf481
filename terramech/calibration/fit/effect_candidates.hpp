#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/fit/candidate.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

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
