#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/trace/trial.hpp>

namespace talus::terramech {

/// One explanation that may be added to a model: an effect of the library, or curves of one covariate in some
/// channels.
struct Candidate {
  std::vector<Effect> parts;  ///< one, or one curve a channel
  std::string family;         ///< "empirical" for curves
  int parameters = 0;         ///< fitted numbers

  bool empirical() const { return parts.front().empirical(); }
  const std::string& covariate() const { return parts.front().covariate; }
};

/// Every effect of the library that the columns of a trial allow, at its typical size, with starts where it
/// is nonlinear; sensor effects also for one group of a text column. `sinkage_m` is the model's.
std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// For every covariate a flat curve in each measured channel, and for every group a constant.
std::vector<Candidate> empiricalCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

}  // namespace talus::terramech
