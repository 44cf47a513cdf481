#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::planner {

/// A number from a sample of worlds and its 95 % interval.
struct Sampled {
  double value = 0.0;
  std::array<double, 2> interval_95{};
};

/// A share of worlds with Wilson's interval (wilson_1927); NaN of none.
Sampled share(std::size_t hits, std::size_t all);

/// A mean with the normal interval of its standard error; NaN of none.
Sampled mean(const std::vector<double>& values);

/// How the drives of some worlds ended.
struct Rates {
  std::size_t worlds = 0;
  std::array<Sampled, 5> outcome{};  ///< shares, in the order of Outcome
  double energy_J = 0.0;             ///< mean where the goal was reached; NaN where it never was
};

Rates ratesOf(const std::vector<WorldResult>& results);

/// A belief compared with perfect knowledge in the same worlds, counted where a safe route exists: where
/// perfect knowledge reached the goal.
struct Comparison {
  Rates rates;                              ///< over those worlds
  Sampled energy_over_perfect_knowledge{};  ///< mean ratio, where both reached the goal [-]
};

/// Both hold the same worlds in the same order. Throws std::invalid_argument when they are not as many.
Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect);

}  // namespace talus::planner
