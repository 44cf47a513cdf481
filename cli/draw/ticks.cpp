#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <talus/cli/draw/ticks.hpp>

namespace talus::cli {

double roundBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-12));
  const double mantissa = value / power * (1.0 + 1e-12);
  return power * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

std::vector<double> ticks(Range range, int count) {
  const double span = range.high - range.low;
  if (!(span > 0.0) || !std::isfinite(span)) return {range.low};
  double step = roundBelow(span / count);
  while (span / step > 1.6 * count) step = roundBelow(2.5 * step * (1.0 + 1e-9));  // the next round number
  std::vector<double> marks;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * span; ++k)
    marks.push_back(k * step);
  return marks;
}

std::string tickLabel(double value, double step) {
  const double clean = std::abs(value) < 1e-9 * step ? 0.0 : value;
  if (std::abs(value) >= 1e6 || (step < 1e-4 && step > 0.0)) return fmt::format("{:.3g}", clean);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", clean, decimals);
}

}  // namespace talus::cli
