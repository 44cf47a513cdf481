#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>

// Wheel equilibria per second over the soils of thesis Table 2.1 (wheel r = b = 0.1 m, 60 to 100 N, slip 0.2
// to 0.8), and the largest difference from double-exponential quadrature to 1e-12 on the same cases (z
// relative, DP over the load).
namespace {

using namespace talus::terramech;

std::vector<WheelCase> tableCases(std::size_t count) {
  std::mt19937_64 random{1};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  struct Range {
    double c_low, c_high, phi_low, phi_high, k_low, k_high;
  };
  constexpr Range kSoils[] = {{0, 1e3, 30, 35, 1.5e6, 2e6},
                              {5e3, 7e3, 20, 25, 1e6, 1.5e6},
                              {2e3, 4e3, 20, 30, 1.5e6, 2e6},
                              {0, 1e3, 30, 35, 2.5e6, 3e6}};
  std::vector<WheelCase> cases;
  for (std::size_t k = 0; k < count; ++k) {
    const Range& s = kSoils[k % 4];
    cases.push_back({.cohesion_Pa = between(s.c_low, s.c_high),
                     .friction_angle_rad = between(s.phi_low, s.phi_high) * talus::kDegree,
                     .sinkage_exponent = between(0.5, 1.2),
                     .sinkage_modulus = between(s.k_low, s.k_high),
                     .shear_modulus_m = between(0.01, 0.03),
                     .load_N = between(60.0, 100.0),
                     .slip = between(0.2, 0.8)});
  }
  return cases;
}

/// A straightforward implementation: C.4 to C.10 by a library's quadrature over the angle, and a bracketed
/// root search.
template <class Quadrature>
class ByLibrary {
 public:
  ByLibrary(const WheelCase& wheel_case, const Quadrature& quadrature)
      : c_(wheel_case), quadrature_(quadrature) {}

  WheelForces solve() const {
    boost::uintmax_t steps = 60;
    const auto excess = [&](double entry) {
      return integral(entry, [](double s, double t, double a) { return s * std::cos(a) + t * std::sin(a); }) -
             c_.load_N;
    };
    const auto stop = [](double a, double b) { return std::abs(a - b) <= 1e-11 * a; };
    const auto [low, high] = boost::math::tools::toms748_solve(excess, 1e-4, 1.57, stop, steps);
    const double entry = 0.5 * (low + high);
    return {c_.wheel_radius_m * (1.0 - std::cos(entry)), entry,
            c_.wheel_radius_m * integral(entry, [](double, double t, double) { return t; }),
            integral(entry, [](double s, double t, double a) { return t * std::cos(a) - s * std::sin(a); })};
  }

 private:
  template <class Density>
  double integral(double entry, const Density& density) const {
    const double r = c_.wheel_radius_m, peak = (c_.c1 + c_.c2 * c_.slip) * entry;
    const auto at = [&](double angle) {
      const double front = angle >= peak ? angle : entry - (entry - peak) * angle / peak;
      const double depth = std::max(0.0, r * (std::cos(front) - std::cos(entry)));
      const double sigma = c_.sinkage_modulus * std::pow(depth, c_.sinkage_exponent);
      const double j = r * ((entry - angle) - (1.0 - c_.slip) * (std::sin(entry) - std::sin(angle)));
      const double tau =
          (c_.cohesion_Pa + sigma * std::tan(c_.friction_angle_rad)) * -std::expm1(-j / c_.shear_modulus_m);
      return density(sigma, tau, angle);
    };
    const double sum = quadrature_(at, 0.0, peak) + quadrature_(at, peak, entry);
    return r * c_.wheel_width_m * sum;
  }

  WheelCase c_;
  const Quadrature& quadrature_;
};

/// Adaptive Gauss-Kronrod to 1e-8, at most 10 bisections deep.
struct GaussKronrod {
  template <class Function>
  double operator()(const Function& f, double a, double b) const {
    return boost::math::quadrature::gauss_kronrod<double, 15>::integrate(f, a, b, 10, 1e-8);
  }
};

/// Double-exponential quadrature, which is insensitive to the powers of n at the end points.
struct TanhSinh {
  template <class Function>
  double operator()(const Function& f, double a, double b) const {
    return rule.integrate([&](double t) { return f(a + t); }, 0.0, b - a, 1e-12);
  }
  mutable boost::math::quadrature::tanh_sinh<double> rule{12};
};

/// Largest difference of the first 100 cases from the most accurate quadrature.
double worstError(const std::vector<WheelCase>& cases, const std::vector<WheelForces>& forces) {
  double worst = 0.0;
  const TanhSinh truth;
  for (std::size_t k = 0; k < 100; ++k) {
    const WheelForces want = ByLibrary{cases[k], truth}.solve();
    worst = std::max({worst, std::abs(forces[k].sinkage_m / want.sinkage_m - 1.0),
                      std::abs(forces[k].drawbar_pull_N - want.drawbar_pull_N) / cases[k].load_N});
  }
  return worst;
}

template <class Solve>
void run(benchmark::State& state, const Solve& solve, std::size_t count = 2000) {
  const auto cases = tableCases(count);
  std::vector<WheelForces> forces(cases.size());
  for (auto _ : state) {
    solve(cases, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(cases.size()));
  state.counters["worst_error"] = worstError(cases, forces);
}

void batchAvx2(benchmark::State& state) {
  run(state, [](const auto& cases, auto& forces) { equilibria(cases, forces, BatchKernel::Avx2); });
}
void batchScalar(benchmark::State& state) {
  run(state, [](const auto& cases, auto& forces) { equilibria(cases, forces, BatchKernel::Scalar); });
}
void oneByOne(benchmark::State& state) {
  run(state, [](const auto& cases, auto& forces) {
    for (std::size_t k = 0; k < cases.size(); ++k) forces[k] = equilibrium(cases[k]);
  });
}
template <class Quadrature>
void byLibrary(benchmark::State& state) {
  const Quadrature quadrature;
  run(
      state,
      [&](const auto& cases, auto& forces) {
        for (std::size_t k = 0; k < cases.size(); ++k) forces[k] = ByLibrary{cases[k], quadrature}.solve();
      },
      100);
}

BENCHMARK(batchAvx2)->Unit(benchmark::kMillisecond);
BENCHMARK(batchScalar)->Unit(benchmark::kMillisecond);
BENCHMARK(oneByOne)->Unit(benchmark::kMillisecond);
BENCHMARK(byLibrary<GaussKronrod>)->Unit(benchmark::kMillisecond);
BENCHMARK(byLibrary<TanhSinh>)->Unit(benchmark::kMillisecond);

}  // namespace
