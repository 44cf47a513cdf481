#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <boost/math/special_functions/erf.hpp>

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
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * p, InDouble());
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
