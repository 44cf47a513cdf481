#pragma once

#include <cstdint>
#include <functional>

#include <talus/planner/pose/hybrid_search.hpp>

namespace talus::planner {

/// Parameters of the improvement by RRT*.
struct PoseSamplingSettings {
  std::uint64_t seed = 1;
  std::uint64_t work = 1'000'000;        ///< limit on the work [evaluated cell lengths], > 0, equal on every
                                         ///< machine; applies only without a time limit
  double range_cells = 30.0;             ///< longest curve added to the tree, > 0
  std::function<void(double)> better{};  ///< called with each lower cost [J]
};

/// Improves a drive with OMPL's RRT* [karaman_frazzoli_2011] over PoseSpace. The tree initially contains the
/// known drive; samples are drawn near that drive and wherever a better drive can still pass
/// (ImprovableRegion). Never returns a costlier drive than the given one, nor a drive refused by
/// mayBeDriven(). Equal seeds give identical results if the work limit is reached before the time limit.
PosePlan improvedBySampling(const PoseProblem& problem, const PosePlan& known,
                            const PoseSamplingSettings& settings);

}  // namespace talus::planner
