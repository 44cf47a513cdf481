#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace talus::terramech {

/// Gauss-Legendre quadrature rule on (0, 1): N ascending nodes, and N weights with sum 1. The rule is exact
/// for polynomials of degree 2 N - 1.
template <std::size_t N>
struct GaussLegendre {
  std::array<double, N> node{};
  std::array<double, N> weight{};
};

namespace detail {

// Taylor series for |x| <= pi; gives initial values of the Newton iteration below.
constexpr double cosine(double x) {
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 16; ++k) sum += term *= -x * x / ((2.0 * k - 1.0) * (2.0 * k));
  return sum;
}

/// Value and derivative of the Legendre polynomial P_N at x.
struct LegendreValue {
  double value;
  double slope;
};

/// Evaluates P_N for N = order by the three-term recurrence.
constexpr LegendreValue legendre(std::size_t order, double x) {
  double previous = 1.0, current = x;
  for (std::size_t k = 2; k <= order; ++k) {
    const auto n = static_cast<double>(k);
    const double next = ((2.0 * n - 1.0) * x * current - (n - 1.0) * previous) / n;
    previous = current;
    current = next;
  }
  return {current, static_cast<double>(order) * (x * current - previous) / (x * x - 1.0)};
}

}  // namespace detail

/// Returns the rule of N nodes. The nodes follow from the roots of P_N, found by Newton's method from a
/// cosine estimate.
template <std::size_t N>
constexpr GaussLegendre<N> gaussLegendre() {
  static_assert(N >= 2);
  GaussLegendre<N> rule;
  for (std::size_t k = 0; k < N; ++k) {
    double x =
        detail::cosine(std::numbers::pi * (static_cast<double>(k) + 0.75) / (static_cast<double>(N) + 0.5));
    for (int step = 0; step < 8; ++step) {
      const auto p = detail::legendre(N, x);
      x -= p.value / p.slope;
    }
    const double slope = detail::legendre(N, x).slope;
    rule.node[k] = 0.5 * (1.0 - x);
    rule.weight[k] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace talus::terramech
