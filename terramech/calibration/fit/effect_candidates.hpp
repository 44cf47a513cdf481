#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/fit/candidate.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// All effects of the library that the columns of a trial permit, at their typical size, with several start
/// values for nonlinear effects; sensor effects also for single groups of a text column. `sinkage_m` is the
/// model's sinkage.
std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Curves of every covariate, initially zero: a line and splines of 4 and 7 knots, each applied to one
/// measured channel, to the soil stiffness or to the soil strength. Columns constant within runs need at
/// least three runs per knot. Further candidates: steps of time, heading and additional columns; for text
/// columns a constant per group; and lines over products ("A*B") of an additional column with slip, load,
/// speed or, for at most six additional columns, another additional column.
std::vector<Candidate> empiricalCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Returns true if a covariate is a product of two columns.
bool isProduct(const std::string& covariate);

/// Returns true for a numeric column that is not one of stateColumns().
bool isOwnColumn(const std::string& column);

/// Returns GainDistribution::further_questions for a search after column screening: ln((kept + dropped) /
/// kept), with the numbers of kept and dropped columns.
double furtherQuestions(const Trial& trial);

/// The coarsest candidates of an additional column: a spline of 4 knots in each measured channel alone; for a
/// text column a constant per group.
std::vector<Candidate> coarseCandidates(const Trial& trial, const std::string& column);

}  // namespace talus::terramech
