#pragma once

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <talus/costmap/evidence/block_grid.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Set of the patches that evidence can affect. A patch is 8x8 blocks, and a block is a square of cells whose
/// evidence is stored together. The estimates of a patch are computed from all evidence that can affect any
/// block of the patch; a changed block therefore changes whole patches. Not thread-safe while changed.
class EvidenceReach {
 public:
  static constexpr int kPatchBlocks = 8;

  explicit EvidenceReach(std::shared_ptr<const GroundSite> site);

  /// Adds the evidence of a block whose position uncertainty is reach_m >= 0 [m]. Returns the box of the
  /// cells of all patches within the correlation length plus reach_m of the block.
  maps::CellBox add(const BlockOfClass& block, double reach_m);

  /// Returns the boxes of cells that evidence can affect, one for each patch.
  std::vector<maps::CellBox> boxes() const;

  /// Returns the greatest position uncertainty of a block [m].
  double farthest_m() const noexcept { return farthest_m_; }

 private:
  maps::CellBox cellsOf(const maps::CellBox& patches) const noexcept;

  std::shared_ptr<const GroundSite> site_;
  BlockGrid blocks_;
  std::set<std::pair<int, int>> patches_;  // patches by row and column
  double farthest_m_ = 0.0;
};

}  // namespace talus::costmap
