#pragma once

#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::cli {

/// Costs per horizontal metre that a file states, by class number. `classed` is false for a file without a column
/// `class`; its one class has the number 0.
struct CostCurves {
  costmap::StatedCosts costs;
  std::vector<int> numbers;  ///< class numbers, ascending, in the order of costs.states
  bool classed = false;
};

/// Reads a cost per horizontal metre over gradients (rise over run) from a CSV file with the columns gradient_along
/// (climbing > 0), cost_per_m, and optionally gradient_across (>= 0, left and right equal) and class (0 to 254). Costs are
/// > 0; an empty field or inf refuses the gradients. Each class has all pairs of its gradients along and across, two
/// or more along, and across from 0. Costs are interpolated bilinearly; gradients beyond the table are refused, and so
/// is a gradient along above 1. Costs must not decrease with the gradient across. @throws InputError
CostCurves readCostCurves(const std::string& path);

}  // namespace talus::cli
