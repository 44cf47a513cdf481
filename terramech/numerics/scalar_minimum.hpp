#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

#include <boost/math/tools/minima.hpp>

namespace talus::terramech {

/// An abscissa and the value there.
struct Minimum {
  double at;
  double value;
};

/// Least value of f over [low, high], both > 0: a scan of `rungs` points even in log, then Brent's method
/// about the best, to 1e-8 of the abscissa.
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
  // Half of the digits: nearer to its minimum a smooth f does not change any more.
  const auto [at, value] = boost::math::tools::brent_find_minima(
      std::forward<F>(f), rung(std::max(0, index - 1)), rung(std::min(rungs - 1, index + 1)), 26);
  const Minimum refined{at, value};
  return refined.value < best.value ? refined : best;
}

}  // namespace talus::terramech
