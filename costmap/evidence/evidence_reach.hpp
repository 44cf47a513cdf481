#pragma once

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <talus/costmap/evidence/block_grid.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// The patches of 8x8 blocks that evidence reaches. Estimates are computed patch by patch, from all evidence that can reach
/// any block of it, so that a changed block changes whole patches. Not thread-safe while changed.
class EvidenceReach {
 public:
  static constexpr int kPatchBlocks = 8;

  explicit EvidenceReach(std::shared_ptr<const GroundSite> site);

  /// Adds the evidence of a block whose place may be so far off, >= 0. Returns the cells of all patches within its reach:
  /// the correlation length and that distance.
  maps::CellBox add(const BlockLevel& block, double reach_m);

  /// Boxes of cells, one a patch: outside of them no evidence counts.
  std::vector<maps::CellBox> boxes() const;

  /// The greatest distance by which the place of a block may be off [m].
  double farthest_m() const noexcept { return farthest_m_; }

 private:
  maps::CellBox cellsOf(const maps::CellBox& patches) const noexcept;

  std::shared_ptr<const GroundSite> site_;
  BlockGrid blocks_;
  std::set<std::pair<int, int>> patches_;  // by row and column
  double farthest_m_ = 0.0;
};

}  // namespace talus::costmap
