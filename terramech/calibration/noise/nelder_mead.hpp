#pragma once

#include <functional>
#include <vector>

namespace talus::terramech {

/// Initial step and stopping criteria of the simplex method.
struct NelderMeadOptions {
  double step = 0.5;        ///< initial edge length of the simplex in every coordinate
  int evaluations = 1000;   ///< greatest number of function evaluations
  double tolerance = 1e-6;  ///< the search stops if the function values over the simplex differ by less
};

/// Returns the minimum of `cost` that the simplex method finds from `start` (nelder_mead_1965). The method
/// suits few coordinates of similar scale.
std::vector<double> nelderMead(const std::function<double(const std::vector<double>&)>& cost,
                               const std::vector<double>& start, const NelderMeadOptions& options);

}  // namespace talus::terramech
