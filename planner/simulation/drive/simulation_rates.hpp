#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::planner {

/// Estimate from a sample of worlds with its 95 % confidence interval.
struct Sampled {
  double value = 0.0;                   ///< estimate
  std::array<double, 2> interval_95{};  ///< lower and upper end
};

/// Returns the share of worlds with Wilson's interval (wilson_1927); NaN if `all` is 0.
Sampled share(std::size_t hits, std::size_t all);

/// Returns the mean with the normal interval of its standard error; NaN if there are no values.
Sampled mean(const std::vector<double>& values);

/// Outcomes of the drives of several worlds.
struct Rates {
  std::size_t worlds = 0;            ///< number of worlds
  std::array<Sampled, 5> outcome{};  ///< shares of the outcomes, in the order of Outcome
  double energy_J = 0.0;             ///< mean of the drives that reached the goal; NaN if there are none
};

/// Outcome shares and mean energy of the results.
Rates ratesOf(const std::vector<WorldResult>& results);

/// Comparison of a soil knowledge with perfect knowledge in the same worlds, restricted to the worlds with a
/// safe route: those in which perfect knowledge reached the goal.
struct Comparison {
  Rates rates;                              ///< over the worlds with a safe route
  Sampled energy_over_perfect_knowledge{};  ///< mean ratio over worlds in which both reached the goal [-]
};

/// Both vectors contain the same worlds in the same order. Throws std::invalid_argument if their sizes
/// differ.
Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect);

}  // namespace talus::planner
