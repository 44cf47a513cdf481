#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace {

constexpr std::array<int, 8> kBases{2, 3, 5, 7, 11, 13, 17, 19};

double radicalInverse(Eigen::Index index, int base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) value += digit * static_cast<double>(index % base);
  return value;
}

}  // namespace

double normalDensity(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

double normalProbability(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normalQuantile(double p) {
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("normal quantile: probability must be in (0, 1)");
  const double tail = std::min(p, 1.0 - p);
  // Lower half only, so that erfc keeps its digits; the crude tail form is within 0.5, Halley's step is
  // cubic.
  const double t = std::sqrt(-2.0 * std::log(tail));
  double x = -(t - (2.515517 + 0.802853 * t + 0.010328 * t * t) /
                       (1.0 + 1.432788 * t + 0.189269 * t * t + 0.001308 * t * t * t));
  for (int step = 0; step < 3; ++step) {
    const double ratio = (normalProbability(x) - tail) / normalDensity(x);
    x -= ratio / (1.0 + 0.5 * x * ratio);
  }
  return p < 0.5 ? x : -x;
}

Eigen::MatrixXd evenPoints(Eigen::Index rows, Eigen::Index count) {
  if (rows > static_cast<Eigen::Index>(kBases.size()))
    throw std::invalid_argument("even points: at most eight rows");
  Eigen::MatrixXd points(rows, count);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index k = 0; k < count; ++k)
      points(row, k) = radicalInverse(k + 1, kBases[static_cast<std::size_t>(row)]);
  }
  return points;
}

}  // namespace talus::terramech
