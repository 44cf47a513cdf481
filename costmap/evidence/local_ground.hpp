#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// What bounds the ground of a block, whatever else is known of it. NaN: not bounded.
struct PlaceBound {
  maps::Point block;           ///< its middle
  double reach_m = 0.0;        ///< how far off the place may be
  double most_pull = 0.0;      ///< drawbar pull over load [-]
  double least_sinkage = 0.0;  ///< sinkage over radius [-]
};

/// A class of ground and what is known of it as a whole.
struct GroundOfClass {
  int class_index = 0;
  ClassState state{};
};

/// The evidence that can reach a piece of ground of one class. Immutable.
struct LocalGround {
  GaussianProcess process;  ///< of what may raise, as departures from the class's posterior mean
  std::vector<WeakPlace> weak,
      lower;  ///< departures from its prior: weaker than the class explains, and ordinary
  std::vector<PlaceBound> bounds;

  bool empty() const noexcept { return process.empty() && weak.empty() && lower.empty() && bounds.empty(); }
};

/// The estimate of ground of a class away from any evidence.
GroundBelief classGround(const GroundModel& model, const GroundOfClass& of);

/// How ground of a class varies over distance.
Variation variationOf(const EvidenceStore& store, int class_index) noexcept;

/// Evidence on the top surface that can reach a patch of blocks, which begins at `patch`.
LocalGround groundAround(const EvidenceStore& store, const BlockLevel& patch, const GroundOfClass& of);

/// Evidence of ground, on the top surface or not, that one can drive to from a level of a block without climbing.
LocalGround groundLevelWith(const EvidenceStore& store, maps::Cell block, std::uint16_t level,
                            const GroundOfClass& of);

}  // namespace talus::costmap
