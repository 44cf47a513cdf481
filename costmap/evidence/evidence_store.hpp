#pragma once

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <talus/costmap/evidence/block_grid.hpp>
#include <talus/costmap/evidence/class_lessons.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/spreading.hpp>

/// What an EvidenceField is made of; not for its users.
namespace talus::costmap {

/// What bounds the ground of a block, whatever else is known of it. NaN: not bounded.
struct PlaceBound {
  maps::Point block;           ///< its middle
  double reach_m = 0.0;        ///< how far off the place may be
  double most_pull = 0.0;      ///< drawbar pull over load [-]
  double least_sinkage = 0.0;  ///< sinkage over radius [-]
};

/// Evidence that can reach a piece of ground of one class.
struct NearbyEvidence {
  int class_index = 0;
  ClassState state{};                   ///< of that class
  std::vector<PlaceEvidence> places{};  ///< departures from the class's posterior mean, of what may raise
  std::vector<WeakPlace> weak{};        ///< departures from the class's prior
  std::vector<WeakPlace> lower{};       ///< likewise, of ordinary ground that may only lower
  std::vector<PlaceBound> bounds{};
};

/// The same, ready to be asked.
struct LocalGround {
  GaussianProcess process;
  std::vector<WeakPlace> weak, lower;
  std::vector<PlaceBound> bounds;
  bool empty() const noexcept { return process.empty() && weak.empty() && lower.empty() && bounds.empty(); }
};

/// Blocks, what they heard, and what that teaches of classes.
struct EvidenceStore {
  explicit EvidenceStore(const std::shared_ptr<const GroundSite>& site)
      : blocks(site),
        bricks(blocks.columns(), blocks.rows()),
        lessons(site->model->parts().classes.begin(), site->model->parts().classes.end()) {}

  BlockGrid blocks;
  EvidenceBricks bricks;
  std::vector<ClassLessons> lessons;        // a class each
  std::set<std::pair<int, int>> reached{};  // patches of blocks, by row and column, where evidence may count
};

}  // namespace talus::costmap
