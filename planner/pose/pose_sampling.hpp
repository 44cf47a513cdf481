#pragma once

#include <cstdint>
#include <functional>

#include <talus/planner/pose/hybrid_search.hpp>

namespace talus::planner {

/// How RRT* improves a drive.
struct PoseSamplingSettings {
  std::uint64_t seed = 1;
  std::uint64_t work = 1'000'000;  ///< cells' lengths priced before it stops, > 0: the same on every machine;
                                   ///< only without time limit
  double range_cells = 30.0;       ///< longest curve added to the tree, > 0
  std::function<void(double)> better{};  ///< called with each better cost in joules
};

/// RRT* [karaman_frazzoli_2011] by OMPL over PoseSpace, its tree begun with a drive known already, sampling
/// beside that drive and wherever a better one can still pass (ImprovableRegion). Never returns a more
/// expensive drive than it was given, nor one that mayBeDriven() refuses. The same bytes for the same seed as
/// long as the work ends before the problem's time limit.
PosePlan improvedBySampling(const PoseProblem& problem, const PosePlan& known,
                            const PoseSamplingSettings& settings);

}  // namespace talus::planner
