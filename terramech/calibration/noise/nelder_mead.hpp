#pragma once

#include <functional>
#include <vector>

namespace talus::terramech {

/// Step and stopping criteria of the simplex method.
struct NelderMeadOptions {
  double step = 0.5;        ///< initial edge length in every coordinate
  int evaluations = 1000;   ///< greatest number of function evaluations
  double tolerance = 1e-6;  ///< stops at this spread of the values over the simplex
};

/// Minimum found by the simplex method from `start` (nelder_mead_1965), for few coordinates of similar scale.
std::vector<double> nelderMead(const std::function<double(const std::vector<double>&)>& cost,
                               const std::vector<double>& start, const NelderMeadOptions& options);

}  // namespace talus::terramech
