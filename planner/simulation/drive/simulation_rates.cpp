#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <talus/planner/simulation/drive/simulation_rates.hpp>

namespace talus::planner {
namespace {

constexpr double kNormal95 = 1.959963984540054;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool reached(const WorldResult& result) {
  return result.drive.outcome == Outcome::Reached;
}

}  // namespace

Sampled share(std::size_t hits, std::size_t all) {
  if (all == 0) return {kNone, {kNone, kNone}};
  const double n = static_cast<double>(all), p = static_cast<double>(hits) / n, zz = kNormal95 * kNormal95;
  const double middle = p + zz / (2.0 * n);
  const double half = kNormal95 * std::sqrt(p * (1.0 - p) / n + zz / (4.0 * n * n));
  const double low = (middle - half) / (1.0 + zz / n), high = (middle + half) / (1.0 + zz / n);
  return {p, {hits == 0 ? 0.0 : low, hits == all ? 1.0 : high}};  // exact, because rounding leaves 1e-17
}

Sampled mean(const std::vector<double>& values) {
  if (values.empty()) return {kNone, {kNone, kNone}};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  const double half = n > 1.0 ? kNormal95 * std::sqrt(squares / (n - 1.0) / n) : kNone;
  return {sum / n, {sum / n - half, sum / n + half}};
}

Rates ratesOf(const std::vector<WorldResult>& results) {
  Rates rates{.worlds = results.size(), .outcome = {}, .energy_J = 0.0};
  for (std::size_t o = 0; o < rates.outcome.size(); ++o) {
    const auto hits = std::count_if(results.begin(), results.end(), [o](const WorldResult& r) {
      return r.drive.outcome == static_cast<Outcome>(o);
    });
    rates.outcome[o] = share(static_cast<std::size_t>(hits), results.size());
  }
  std::vector<double> energies;
  for (const WorldResult& r : results)
    if (reached(r)) energies.push_back(r.drive.energy_J);
  rates.energy_J = mean(energies).value;
  return rates;
}

Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect) {
  if (results.size() != perfect.size())
    throw std::invalid_argument("compared: " + std::to_string(results.size()) + " worlds against " +
                                std::to_string(perfect.size()) + ", must be as many");
  std::vector<WorldResult> passable;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!reached(perfect[i])) continue;
    passable.push_back(results[i]);
    if (reached(results[i])) ratios.push_back(results[i].drive.energy_J / perfect[i].drive.energy_J);
  }
  return {ratesOf(passable), mean(ratios)};
}

}  // namespace talus::planner
