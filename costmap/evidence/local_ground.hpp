#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// Bounds of the ground in a block, independent of all other evidence. NaN: no bound.
struct PlaceBound {
  maps::Point block;           ///< centre of the block
  double reach_m = 0.0;        ///< position uncertainty of the place [m]
  double most_pull = 0.0;      ///< upper bound of drawbar pull over load [-]
  double least_sinkage = 0.0;  ///< lower bound of sinkage over radius [-]
};

/// A class of ground and its state.
struct GroundOfClass {
  int class_index = 0;
  ClassState state{};
};

/// Evidence within reach of a patch of ground of one class. Immutable.
struct LocalGround {
  GaussianProcess process;  ///< readings that may raise, as departures from the class's posterior mean
  std::vector<WeakPlace> weak,
      lower;  ///< departures from the prior: `weak` beyond the variation of the class, `lower` within
  std::vector<PlaceBound> bounds;

  bool empty() const noexcept { return process.empty() && weak.empty() && lower.empty() && bounds.empty(); }
};

/// Estimate for ground of a class without nearby evidence.
GroundBelief classGround(const GroundModel& model, const GroundOfClass& of);

/// Spatial variation of ground of a class.
Variation variationOf(const EvidenceStore& store, int class_index) noexcept;

/// Evidence on the top surface within reach of a patch of 8x8 blocks; `patch` is its south-west block.
LocalGround groundAround(const EvidenceStore& store, const BlockLevel& patch, const GroundOfClass& of);

/// Evidence of the class on all surfaces, top surface and floors, that gradients of at most 0.6 connect with
/// a level of a block.
LocalGround groundLevelWith(const EvidenceStore& store, maps::Cell block, std::uint16_t level,
                            const GroundOfClass& of);

}  // namespace talus::costmap
