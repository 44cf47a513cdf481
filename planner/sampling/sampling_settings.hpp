#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace talus::planner {

/// How OMPL's planners are run. Defaults are what did best on maps of 1000x1000 cells.
struct SamplingSettings {
  std::string planner = "RRTstar";  ///< a name of plannerNames(), not "field"
  std::uint64_t work =
      4'000'000;              ///< cells' lengths evaluated before it stops, > 0: the same on every machine;
                              ///< only where the problem has no time limit, which is used up else
  double range_cells = 40.0;  ///< longest motion added to a tree, > 0
  std::function<void(double)> better{};  ///< called with each better cost of the leg in work, in joules
};

}  // namespace talus::planner
