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

/// Data of an EvidenceField: blocks (squares of cells), their readings, the evidence of terrain classes, and
/// the patches of blocks that evidence can affect. Internal to EvidenceField and to the computation of
/// estimates.
struct EvidenceStore {
  explicit EvidenceStore(std::shared_ptr<const GroundSite> of)
      : site(std::move(of)),
        blocks(site),
        bricks(blocks.columns(), blocks.rows()),
        reach(site),
        classes(site->model->parts().classes.begin(), site->model->parts().classes.end()) {}

  std::shared_ptr<const GroundSite> site;
  BlockGrid blocks;
  EvidenceBricks bricks;
  EvidenceReach reach;
  /// Evidence of each terrain class, in the order of the model's classes.
  std::vector<ClassEvidence> classes;

  const GroundModel& model() const noexcept { return *site->model; }
  const GroundClass& groundClass(int class_index) const noexcept {
    return model().parts().classes[static_cast<std::size_t>(class_index)];
  }
  /// Returns the key of the evidence of a class on the top surface, in the block that contains a cell.
  BlockOfClass topOf(maps::Cell cell, int class_index) const noexcept {
    return {blocks.columnOf(cell), blocks.rowOf(cell),
            static_cast<std::uint8_t>(groundClass(class_index).number)};
  }
};

}  // namespace talus::costmap
