#pragma once

#include <cmath>
#include <concepts>

namespace talus::terramech {

/// An abscissa and the value there.
struct Minimum {
  double at;
  double value;
};

/// Least value of f over [low, high], both > 0: a scan of `rungs` points even in log, then golden sections
/// about the best.
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
  constexpr double kGolden = 0.6180339887498949;
  double a = rung(std::max(0, index - 1));
  double b = rung(std::min(rungs - 1, index + 1));
  double x = b - kGolden * (b - a);
  double y = a + kGolden * (b - a);
  double fx = f(x);
  double fy = f(y);
  while (b - a > 1e-9 * b) {
    if (fx < fy) {
      b = y, y = x, fy = fx;
      fx = f(x = b - kGolden * (b - a));
    } else {
      a = x, x = y, fx = fy;
      fy = f(y = a + kGolden * (b - a));
    }
  }
  const Minimum refined = fx < fy ? Minimum{x, fx} : Minimum{y, fy};
  return refined.value < best.value ? refined : best;
}

}  // namespace talus::terramech
