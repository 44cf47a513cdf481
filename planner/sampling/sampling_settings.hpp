#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace talus::planner {

/// Settings of OMPL's planners. The defaults performed best on maps of 1000 x 1000 cells.
struct SamplingSettings {
  std::string planner = "RRTstar";  ///< a name of plannerNames() except "field"
  /// Limit on the work [evaluated cell lengths], > 0, equal on every machine; applies only to problems
  /// without a time limit.
  std::uint64_t work = 4'000'000;
  double range_cells = 40.0;  ///< longest motion added to a tree, > 0
  bool cold = false;          ///< true: no initial route; false: starts from the field planner's route
  std::map<std::string, std::string> parameters{};  ///< parameters of OMPL's planner, in its own units
  std::function<void(double)> better{};             ///< called with each lower cost of the present leg [J]
};

/// Parses "NAME", "NAME:cold", "NAME:range=20:cold": a planner of plannerNames() and its settings. Throws
/// std::invalid_argument for an unknown name, for cold or a parameter of a planner that is not OMPL's, for an
/// unknown parameter and for an invalid value.
SamplingSettings samplingSettings(const std::string& words);

/// All planner names, and OMPL's planners with ":cold".
std::vector<std::string> warmAndCold();

/// The text from which samplingSettings() gives these settings.
std::string wordsOf(const SamplingSettings& settings);

}  // namespace talus::planner
