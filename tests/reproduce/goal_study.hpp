#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <talus/common/common.hpp>

namespace talus::reproduce {

/// One line of the table of what the estimators reach.
struct GoalLine {
  std::string quantity;
  std::string reached;
  std::string goal;  ///< empty: for comparison only
};

/// What is measured.
struct GoalOptions {
  std::uint64_t seed = 1;
  int soils = 500;
  std::string measured;  ///< CSV with torque, sinkage and drawbar pull measured; empty: that line is left out
};

/// Measures the error and the run time of each estimation goal over thesis Table 2.1, with ten samples per
/// soil as in the thesis. For the same seed the errors are the same.
std::vector<GoalLine> measureGoals(const GoalOptions& options, const ProgressMonitor& watch);

}  // namespace talus::reproduce
