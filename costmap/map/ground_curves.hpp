#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/evidence/class_lessons.hpp>
#include <talus/costmap/evidence/evidence_beliefs.hpp>
#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/ground/wheel_swath.hpp>
#include <talus/costmap/site/added_cost.hpp>

namespace talus::costmap {

/// Which cost curve the ground of each cell has: that of its own ground where all ground that a wheel may touch
/// is like it, else what WheelSwath makes of them. Keeps the ground of cells that were learned, rounded as
/// GroundKind, so that a cell is judged anew only when ground within its reach changed. Not thread-safe.
class GroundCurves {
 public:
  explicit GroundCurves(std::shared_ptr<const GroundSite> site);

  const CostCurveTable& table() const noexcept { return table_; }

  /// Number of the curve of a cell whose class has a soil; CellCode::kUnknown where a wheel may touch ground without a
  /// class, unless the policy allows that.
  std::uint8_t number(maps::Cell cell);
  /// The same of a cell that nobody has seen, where the policy takes it for level ground of the first class.
  std::uint8_t numberOfUnseen(maps::Cell cell) { return withLayers(table_.prior(0), cell); }

  /// What taking over the classes' beliefs changes.
  struct ClassChange {
    bool priors = false;   ///< of ground that nobody drove on
    bool learned = false;  ///< what learned ground has of its class
  };
  /// Takes over what is believed of the classes.
  ClassChange learnClasses(const EvidenceField& field);
  /// Takes over what is believed of the cells of the ranges, with classes in steps. The ranges in which numbers may have
  /// changed.
  std::vector<maps::CellBox> learn(EvidenceBeliefs& beliefs, const std::vector<maps::CellBox>& ranges);

  /// Takes over the site's classes in a box, which have changed. The box in which numbers may have, too.
  maps::CellBox takeClasses(const maps::CellBox& box);

  /// Where more than one ground takes part in a number, some of which may be a class's prior.
  std::vector<maps::CellBox> mixedRanges() const;

  /// Gives all numbers anew, after it ran out of them, in steps that are coarser the higher the level is.
  /// Steps of layers grow coarse before beliefs do: those decide what may be driven.
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
  std::vector<ClassState> states_;  // that learned_ rests on
  bool any_learned_ = false;
  std::vector<WheelSwath::Ground> around_;
};

}  // namespace talus::costmap
