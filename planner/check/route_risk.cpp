#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/math/special_functions/erf.hpp>

#include <talus/planner/check/route_risk.hpp>

namespace talus::planner {
namespace {

// Ground with a reserve beyond this many deviations fails in no world that is drawn.
constexpr double kSafe = 8.0;

// One stretch of the route between two vertices.
struct Stretch {
  double beta = kSafe;       // reliability index
  double correlation = 1.0;  // of its soil with that of the stretch before
};

// beta with P(u < -beta) = p for a standard Gaussian u.
double reliabilityIndex(double p) {
  if (!(p > 0)) return kSafe;
  return std::clamp(std::sqrt(2.0) * boost::math::erfc_inv(2.0 * std::min(p, 1.0 - 1e-12)), -kSafe, kSafe);
}

std::vector<Stretch> stretches(const Route& route, double correlation_length_m) {
  std::vector<Stretch> made;
  for (std::size_t i = 1; i < route.vertices.size(); ++i) {
    const RouteVertex& a = route.vertices[i - 1];
    const RouteVertex& b = route.vertices[i];
    const double metres = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (!(metres > 0)) {
      made.push_back({});
      continue;
    }
    const double hazard =
        std::log1p(-a.immobilisation_risk) - std::log1p(-std::min(b.immobilisation_risk, 1.0 - 1e-15));
    const double p = -std::expm1(-hazard / metres * correlation_length_m);
    made.push_back({.beta = reliabilityIndex(p), .correlation = std::exp(-metres / correlation_length_m)});
  }
  return made;
}

void validate(const RouteRiskOptions& options) {
  if (!(options.correlation_length_m > 0))
    throw std::invalid_argument("route risk: correlation_length_m must be > 0");
  if (!(options.tail > 0 && options.tail <= 1))
    throw std::invalid_argument("route risk: tail must be in (0, 1]");
  if (options.worlds < 1) throw std::invalid_argument("route risk: worlds must be > 0");
}

struct Least {
  double reserve = kSafe;
  std::size_t where = 0;
};

Least drivenOnce(const std::vector<Stretch>& route, std::mt19937_64& random,
                 std::normal_distribution<double>& gauss) {
  Least least;
  double u = gauss(random);
  for (std::size_t i = 0; i < route.size(); ++i) {
    const double rho = route[i].correlation;
    if (i > 0) u = rho * u + std::sqrt(1.0 - rho * rho) * gauss(random);
    if (route[i].beta + u < least.reserve) least = {route[i].beta + u, i};
  }
  return least;
}

}  // namespace

RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options) {
  validate(options);
  const std::vector<Stretch> way = stretches(route, options.correlation_length_m);
  if (way.empty()) return {.immobilisation = 0.0, .standard_error = 0.0, .cvar = kSafe};
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> gauss;
  std::vector<double> reserves;
  std::vector<int> worst_at(way.size());
  for (int world = 0; world < options.worlds; ++world) {
    const Least least = drivenOnce(way, random, gauss);
    reserves.push_back(least.reserve);
    ++worst_at[least.where];
  }
  std::ranges::sort(reserves);
  const auto stuck = std::ranges::lower_bound(reserves, 0.0) - reserves.begin();
  const auto n = static_cast<double>(options.worlds);
  const auto tail = std::max<std::ptrdiff_t>(1, std::lround(options.tail * n));
  RouteRisk risk;
  risk.immobilisation = static_cast<double>(stuck) / n;
  risk.standard_error = std::sqrt(risk.immobilisation * (1.0 - risk.immobilisation) / n);
  for (std::ptrdiff_t i = 0; i < tail; ++i)
    risk.cvar += reserves[static_cast<std::size_t>(i)] / static_cast<double>(tail);
  const auto worst = std::ranges::max_element(worst_at) - worst_at.begin();
  risk.worst_x_m = route.vertices[static_cast<std::size_t>(worst)].x_m;
  risk.worst_y_m = route.vertices[static_cast<std::size_t>(worst)].y_m;
  return risk;
}

}  // namespace talus::planner
