#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::planner {

/// Estimate of a quantity from a sample of worlds (random draws of the soils), with its 95 % confidence
/// interval.
struct Sampled {
  double value = 0.0;                   ///< estimate
  std::array<double, 2> interval_95{};  ///< lower and upper end of the interval
};

/// Returns the share hits / all with Wilson's interval (wilson_1927); NaN if `all` is 0.
Sampled share(std::size_t hits, std::size_t all);

/// Returns the mean of the values with the normal interval of its standard error; NaN if there are no values.
Sampled mean(const std::vector<double>& values);

/// Rates of the outcomes of drives in several worlds, and their mean energy.
struct Rates {
  std::size_t worlds = 0;            ///< number of worlds
  std::array<Sampled, 5> outcome{};  ///< share of each outcome, in the order of the enumeration Outcome
  double energy_J = 0.0;             ///< mean energy of the drives that reached the goal; NaN if no drive did
};

/// Returns the rates of the outcomes and the mean energy of `results`.
Rates ratesOf(const std::vector<WorldResult>& results);

/// Comparison of drives with a given soil knowledge and drives with perfect knowledge in the same worlds.
/// Only worlds with a safe route count, that is, worlds in which the drive with perfect knowledge reached the
/// goal.
struct Comparison {
  Rates rates;  ///< rates of the given soil knowledge over the worlds with a safe route
  /// Mean ratio of the energies, over worlds in which both drives reached the goal [-].
  Sampled energy_over_perfect_knowledge{};
};

/// Returns the comparison of `results` with `perfect`, the results with perfect knowledge. Both vectors
/// contain the same worlds in the same order. Throws std::invalid_argument if their sizes differ.
Comparison compared(const std::vector<WorldResult>& results, const std::vector<WorldResult>& perfect);

}  // namespace talus::planner
