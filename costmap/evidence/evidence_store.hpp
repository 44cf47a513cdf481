#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/evidence/block_grid.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/evidence_reach.hpp>
#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Data of an EvidenceField: blocks, their readings, the evidence of classes, and the patches within reach.
/// Internal to EvidenceField and the computation of estimates.
struct EvidenceStore {
  explicit EvidenceStore(std::shared_ptr<const GroundSite> of)
      : site(std::move(of)),
        blocks(site),
        bricks(blocks.columns(), blocks.rows()),
        reach(site),
        contributions(site->model->parts().classes.begin(), site->model->parts().classes.end()) {}

  std::shared_ptr<const GroundSite> site;
  BlockGrid blocks;
  EvidenceBricks bricks;
  EvidenceReach reach;
  std::vector<ClassEvidence> contributions;  ///< one for each class

  const GroundModel& model() const noexcept { return *site->model; }
  const GroundClass& groundClass(int class_index) const noexcept {
    return model().parts().classes[static_cast<std::size_t>(class_index)];
  }
  /// The top-surface level, with a class, of the block that contains a cell.
  BlockLevel topOf(maps::Cell cell, int class_index) const noexcept {
    return {blocks.columnOf(cell), blocks.rowOf(cell), BlockEvidence::kTop,
            static_cast<std::uint8_t>(groundClass(class_index).number)};
  }
};

}  // namespace talus::costmap
