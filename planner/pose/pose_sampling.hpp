#pragma once

#include <cstdint>
#include <functional>

#include <talus/planner/pose/hybrid_search.hpp>

namespace talus::planner {

/// Parameters of the improvement of a drive (route of arcs and turns in place) by RRT*.
struct PoseSamplingSettings {
  std::uint64_t seed = 1;
  /// Work limit [evaluated cell lengths], > 0, the same on every machine; only without a time limit.
  std::uint64_t work = 1'000'000;
  double range_cells = 30.0;  ///< length of the longest curve that is added to the tree [cells], > 0
  std::function<void(double)> better{};  ///< called with the cost [J] of each improvement
};

/// Improves the drive `known` by RRT* of OMPL [karaman_frazzoli_2011] over PoseSpace. The tree initially
/// contains the known drive. Samples are drawn near this drive, and in the region through which a cheaper
/// drive may lead (ImprovableRegion). The result is never more expensive than the known drive, and
/// mayBeDriven() is true for it. Equal seeds give identical results if the work limit is reached before the
/// time limit.
PosePlan improvedBySampling(const PoseProblem& problem, const PosePlan& known,
                            const PoseSamplingSettings& settings);

}  // namespace talus::planner
