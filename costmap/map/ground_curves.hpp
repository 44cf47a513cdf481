#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/ground/wheel_swath.hpp>
#include <talus/costmap/site/added_cost.hpp>

namespace talus::costmap {

/// Assigns a cost curve to the ground of each cell: the curve of the cell's ground if all ground that a wheel
/// may touch is equal, else the curve of the ground by WheelSwath. Stores the learned ground of cells as
/// GroundKind, and recomputes cells only after changes within reach. Not thread-safe.
class GroundCurves {
 public:
  explicit GroundCurves(std::shared_ptr<const GroundSite> site);

  const CostCurveTable& table() const noexcept { return table_; }

  /// Curve number of a cell whose class has a soil. CellCode::kUnknown if a wheel may touch ground without a
  /// class and the policy excludes unknown ground.
  std::uint8_t number(maps::Cell cell);
  /// Curve number of an unseen cell that the policy allows, as ground of the first class.
  std::uint8_t numberOfUnseen(maps::Cell cell) { return withLayers(table_.prior(0), cell); }

  /// Changes by learnClasses().
  struct ClassChange {
    bool priors = false;   ///< true if priors of classes changed
    bool learned = false;  ///< true if a class state used for learned ground changed
  };
  /// Updates the estimates of the classes.
  ClassChange learnClasses(const EvidenceField& field);
  /// Updates the estimates of the cells of the ranges, with class states in steps. Returns the ranges whose
  /// curve indices may have changed.
  std::vector<maps::CellBox> learn(EvidenceBeliefs& beliefs, const std::vector<maps::CellBox>& ranges);

  /// Reads changed terrain classes of the site in a box. Returns the box whose curve indices may have
  /// changed.
  maps::CellBox takeClasses(const maps::CellBox& box);

  /// Returns boxes that contain all cells whose curve depends on several kinds of ground.
  std::vector<maps::CellBox> mixedRanges() const;

  /// Discards all curve indices when no index is free; a higher level has coarser steps. The steps of cost
  /// layers become coarser before those of estimates, because estimates determine which ground is drivable.
  void restart(int level) {
    level_ = level;
    step_level_ = added_.empty() ? 0 : std::min(level, AddedCost::kCoarsest);
    table_.restart(level - step_level_);
  }
  int level() const noexcept { return level_; }
  int coarsest() const noexcept {
    return GroundKind::kCoarsest + (added_.empty() ? 0 : AddedCost::kCoarsest);
  }

 private:
  WheelSwath::Ground ground(maps::Cell cell) const;
  std::uint8_t numberOfGround(maps::Cell cell);
  std::uint8_t withLayers(std::uint8_t number, maps::Cell cell);
  bool alike(maps::Cell cell) const noexcept;
  maps::CellBox within(const maps::CellBox& range) const noexcept;

  std::shared_ptr<const GroundSite> site_;
  CostCurveTable table_;
  AddedCost added_;
  int level_ = 0, step_level_ = 0;
  WheelSwath swath_;
  std::vector<bool> borders_;
  LearnedCells learned_;
  std::vector<ClassState> states_;  // class states used for learned_
  bool any_learned_ = false;
  std::vector<WheelSwath::Ground> around_;
};

}  // namespace talus::costmap
