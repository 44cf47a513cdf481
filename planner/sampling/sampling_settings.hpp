#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace talus::planner {

/// How OMPL's planners are run. Defaults are what did best on maps of 1000x1000 cells.
struct SamplingSettings {
  std::string planner = "RRTstar";  ///< a name of plannerNames(), not "field"
  std::uint64_t work =
      4'000'000;              ///< cells' lengths evaluated before it stops, > 0: the same on every machine;
                              ///< only where the problem has no time limit, which is used up else
  double range_cells = 40.0;  ///< longest motion added to a tree, > 0
  bool cold = false;          ///< begins with nothing; else with the route that the field knows
  std::map<std::string, std::string> parameters{};  ///< of OMPL's planner, by its own names and in its units
  std::function<void(double)> better{};  ///< called with each better cost of the leg in work, in joules
};

/// "NAME", "NAME:cold", "NAME:range=20:cold": a planner of plannerNames() and how it is run. Throws std::invalid_argument for a name
/// that is not on offer, and for cold or a parameter where the planner has none such or does not take the value.
SamplingSettings samplingSettings(const std::string& words);

/// All planners on offer, OMPL's from the field's route and cold.
std::vector<std::string> warmAndCold();

/// The words that give these settings, the offered name first.
std::string wordsOf(const SamplingSettings& settings);

}  // namespace talus::planner
