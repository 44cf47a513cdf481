#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// Bounds of the ground in a block (square of cells), independent of all other evidence. NaN: no bound.
struct PlaceBound {
  maps::Point block;           ///< centre of the block
  double reach_m = 0.0;        ///< position uncertainty of the readings [m]
  double most_pull = 0.0;      ///< upper bound of drawbar pull over load [-]
  double least_sinkage = 0.0;  ///< lower bound of sinkage over radius [-]
};

/// Index of a terrain class, and the state of the class after all evidence.
struct GroundOfClass {
  int class_index = 0;
  ClassState state{};
};

/// Evidence that can affect the ground of one terrain class in one patch. A patch is 8x8 blocks. Immutable.
struct LocalGround {
  /// Readings that may raise an estimate, as departures from the posterior mean of the class.
  GaussianProcess process;
  /// Places with departures from the prior of the class. `weak`: ground weaker than the variation of the
  /// class explains. `lower`: departures within that variation, which may only lower an estimate.
  std::vector<WeakPlace> weak, lower;
  std::vector<PlaceBound> bounds;

  bool empty() const noexcept { return process.empty() && weak.empty() && lower.empty() && bounds.empty(); }
};

/// Returns the estimate for ground of a class without nearby evidence.
GroundBelief classGround(const GroundModel& model, const GroundOfClass& of);

/// Returns the spatial variation of ground of a class.
Variation variationOf(const EvidenceStore& store, int class_index) noexcept;

/// Returns the evidence on the top surface that can affect the patch of 8x8 blocks with the south-west block
/// `patch`.
LocalGround groundAround(const EvidenceStore& store, const BlockLevel& patch, const GroundOfClass& of);

}  // namespace talus::costmap
