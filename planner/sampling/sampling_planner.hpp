#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/route/problem.hpp>

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

/// Finds a route to improve on for a problem without via points; not Found: none is known.
using InitialPathProvider = std::function<Plan(const Problem& leg)>;

/// Plans with OMPL's sampling planners under the exact cost, leg by leg through the via points; never returns
/// a worse route than the scout knew, nor one that is not allowed along its whole length. The same bytes for
/// the same problem and seed where there is no time limit; with one, what the machine finds in that time. An
/// empty scout: the planners start from nothing. Throws std::invalid_argument for a planner that is not on
/// offer or a setting out of range.
Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout = {});

}  // namespace talus::planner
