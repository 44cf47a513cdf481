#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/calibration/fit/candidate.hpp>
#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Every effect of the library that the columns of a trial allow, at its typical size, with starts where it
/// is nonlinear; sensor effects also for one group of a text column. `sinkage_m` is the model's.
std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Flat curves of every covariate in each measured channel alone, through stiffness and through strength: a line,
/// splines of 4 and 7 knots, of what is fixed in runs with three runs a knot at least; of time, heading and columns of one's own steps; of text columns a constant for each
/// group; lines over products of a column of one's own with another, with slip, load or speed ("A*B").
std::vector<Candidate> empiricalCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Whether a covariate is the product of two columns.
bool isProduct(const std::string& covariate);

/// Whether a numeric column is none that every table may have (stateColumns()).
bool isOwnColumn(const std::string& column);

/// GainDistribution::further_questions of a search in the columns that a screening kept: ln((kept + dropped) / kept).
double furtherQuestions(const Trial& trial);

/// The coarsest question to a column of one's own: in each measured channel alone a spline of 4 knots, or of a text
/// column a constant for each group.
std::vector<Candidate> coarseCandidates(const Trial& trial, const std::string& column);

}  // namespace talus::terramech
