#include "risk.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace safety {
namespace {

constexpr std::size_t kMostStations = 150;
// The ground immobilises a rover if no slip up to 1 gives enough pull; a route is refused from
// PullCurve::kMostSlip on.
constexpr double kStrongestSlip = 1.0;

// One section of the route.
struct Stretch {
  Station at;
  int class_number = 0;
  double reserve = 0.0;  // largest reduction of DP/W below the mean estimate for which an equilibrium exists
  double metres = 0.0;
};

std::vector<Stretch> stretches(const Site& site, const Belief& belief, const Route& route) {
  const double apart_m = std::max(1.0, route.length_m() / static_cast<double>(kMostStations));
  const Judge judge(site, belief);
  std::vector<Stretch> found;
  double next_m = 0.0;
  for (const Station& at : route.stations(0.25 * apart_m)) {
    if (at.turning || at.along_m < next_m) continue;
    next_m = at.along_m + apart_m;
    const auto cell = site.elevation_m.cellAt(at.place);
    const auto number = site.classAt(at.place);
    if (!cell || !number) continue;
    const Plane plane = planeUnder(site.elevation_m, *cell, site.footprint_m());
    const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
    const Judge::Planar gradient{plane.east * c + plane.north * s, plane.north * c - plane.east * s};
    const auto wheels = judge.wheels(at, gradient);
    // The last section ends with the route.
    const double metres = std::min(apart_m, route.length_m() - at.along_m);
    if (wheels && metres > 0.0)
      found.push_back(
          {at, *number, Judge::reserve(*wheels, Judge::demand(gradient), kStrongestSlip), metres});
  }
  return found;
}

// Computes the lower Cholesky factor of a covariance in place; pivots below zero from rounding are set to
// zero.
void factorise(std::vector<double>& a, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j)
        a[i * n + i] = std::sqrt(std::max(sum, 1e-14));
      else
        a[i * n + j] = sum / a[j * n + j];
    }
}

// Sections on ground of one class, and the Cholesky factor of the covariance of their departures.
struct Ground {
  std::vector<std::size_t> stretches;
  std::vector<double> factor;
};

std::map<int, Ground> grounds(const Belief& belief, const std::vector<Stretch>& route) {
  std::map<int, Ground> found;
  for (std::size_t i = 0; i < route.size(); ++i) found[route[i].class_number].stretches.push_back(i);
  for (auto& [number, ground] : found) {
    std::vector<Place> places;
    for (const std::size_t i : ground.stretches) places.push_back(route[i].at.place);
    ground.factor = belief.covariance(number, places);
    factorise(ground.factor, places.size());
  }
  return found;
}

}  // namespace

DrawnRisk drawnRisk(const Site& site, const Belief& belief, const Route& route, const RiskDraw& draw) {
  const auto way = stretches(site, belief, route);
  const auto ground = grounds(belief, way);
  std::mt19937_64 random(draw.seed);
  std::normal_distribution<double> normal;
  DrawnRisk risk;
  double sum = 0.0, squares = 0.0;
  for (int world = 0; world < draw.worlds; ++world) {
    double weak_m = 0.0;
    for (const auto& [number, of] : ground) {
      const std::size_t n = of.stretches.size();
      std::vector<double> u(n);
      for (double& value : u) value = normal(random);
      for (std::size_t i = 0; i < n; ++i) {
        double departure = 0.0;
        for (std::size_t k = 0; k <= i; ++k) departure += of.factor[i * n + k] * u[k];
        const Stretch& stretch = way[of.stretches[i]];
        if (stretch.reserve + departure < 0.0) weak_m += stretch.metres;
      }
    }
    const double held = 1.0 - std::pow(1.0 - draw.entrapment, weak_m / Belief::kRange_m);
    risk.weak_worlds += weak_m > 0.0 ? 1 : 0;
    sum += held;
    squares += held * held;
  }
  risk.immobilisation = sum / draw.worlds;
  risk.standard_error = std::sqrt(
      std::max(squares / draw.worlds - risk.immobilisation * risk.immobilisation, 0.0) / draw.worlds);
  return risk;
}

}  // namespace safety
