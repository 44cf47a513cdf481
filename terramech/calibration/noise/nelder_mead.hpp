#pragma once

#include <functional>
#include <vector>

namespace talus::terramech {

/// When the simplex stops.
struct NelderMeadOptions {
  double step = 0.5;        ///< first edge, in every coordinate
  int evaluations = 1000;   ///< at most
  double tolerance = 1e-6;  ///< spread of the values over the simplex at which it is done
};

/// The lowest point that the simplex method finds from `start` (nelder_mead_1965), for few coordinates of
/// like scale.
std::vector<double> nelderMead(const std::function<double(const std::vector<double>&)>& cost,
                               const std::vector<double>& start, const NelderMeadOptions& options);

}  // namespace talus::terramech
