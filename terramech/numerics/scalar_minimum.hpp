#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

#include <boost/math/tools/minima.hpp>

namespace talus::terramech {

/// Minimum of a function: abscissa and function value.
struct Minimum {
  double at;
  double value;
};

/// Returns the minimum of f over [low, high], 0 < low < high. The function is first evaluated at `rungs`
/// logarithmically spaced points. Brent's method then refines the best point to 1e-8 of the abscissa.
template <std::invocable<double> F>
Minimum globalMinimum(F&& f, double low, double high, int rungs = 64) {
  const double step = std::log(high / low) / (rungs - 1);
  const auto rung = [&](int i) { return low * std::exp(step * i); };
  Minimum best{low, f(low)};
  int index = 0;
  for (int i = 1; i < rungs; ++i) {
    const double value = f(rung(i));
    if (value < best.value) best = {rung(i), value}, index = i;
  }
  // 26 bits are half of a double's precision; closer to the minimum, a smooth f is constant within rounding.
  const auto [at, value] = boost::math::tools::brent_find_minima(
      std::forward<F>(f), rung(std::max(0, index - 1)), rung(std::min(rungs - 1, index + 1)), 26);
  const Minimum refined{at, value};
  return refined.value < best.value ? refined : best;
}

}  // namespace talus::terramech
