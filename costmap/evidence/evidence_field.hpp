#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// What a file keeps of a block: its south-west cell counted from the map's, its level and class, and all its
/// readings.
struct SavedBlock {
  BlockLevel block;
  std::uint32_t updated_s = 0;
  std::uint8_t reach = 0;  ///< steps of 0.1 m
  std::vector<ReadingCount> heard;
};

struct BlockContribution;
struct ClassPosterior;
struct ClassState;
struct EvidenceStore;

/// What the wheels measured, by place: blocks of ground, each class of ground in a block with its own evidence, spread
/// to neighbours of the same class by a Gaussian process over the class mean, and a posterior of each class.
///
/// A block is the largest power of two of cells no wider than a quarter of the correlation length, on the
/// octree's own lines, so that a sample's work does not depend on the map's resolution. What was driven
/// beneath an overhang stays on its floor: it is no evidence of the top surface, and of the first class of
/// ground only where no raster names classes. Same evidence in any order, same bits. Not thread-safe
/// while changed.
///
/// Evidence lowers a belief at once and for all: around each place that is weaker than its class explains, or
/// that may only lower, no ground is estimated better than that place alone implies. Evidence raises
/// it, or makes it surer, only where at least three independent places of the class may raise, and by no more
/// than each of them reaches; until then no belief is better than that of the class away from any evidence.
class EvidenceField {
 public:
  explicit EvidenceField(std::shared_ptr<const GroundSite> site);
  ~EvidenceField();
  EvidenceField(EvidenceField&&) noexcept;
  EvidenceField& operator=(EvidenceField&&) noexcept;

  /// Takes an observation in and returns the cells whose belief it may change while the classes keep their states: those of
  /// all patches of blocks that it can reach; nothing when the place is outside the map, has no class, or
  /// lies in a block that was first driven on ground of another class.
  std::optional<maps::CellBox> add(const WheelObservation& observation);
  /// The counts that an observation goes into, and where, while the ground is as it is; nothing where add() has none.
  std::optional<SavedBlock> heardOf(const WheelObservation& observation) const;
  /// Takes the pulls and sinkages of counts that were added off again; bounds of the place stay. Nothing where the block has
  /// no evidence.
  std::optional<maps::CellBox> forget(const SavedBlock& heard);

  /// What beliefs have of the classes: all that is known of them, or that in steps rounded towards danger
  /// (ClassEvidence::stateInSteps()), from which a map is published.
  enum class Classes : std::uint8_t { AsKnown, InSteps };

  /// Own evidence, of the cell's class, of the block that holds the cell, on top; null where nobody drove.
  const BlockEvidence* evidence(maps::Cell cell) const noexcept;
  /// The same of a floor beneath it.
  const BlockEvidence* evidence(maps::Cell cell, const Floor& floor) const;
  /// Readings behind it, each weighed by its certainty [-].
  double samplesOf(maps::Cell cell) const;
  double samplesOf(maps::Cell cell, const Floor& floor) const;
  /// What is believed of the ground of a floor: its own evidence and that of ground level with it.
  GroundBelief floorBelief(maps::Cell cell, const Floor& floor) const;

  /// Evidence of a floor beneath the top, and a cell that has that floor.
  struct FloorEvidence {
    maps::Cell cell;
    BlockEvidence evidence;
  };
  /// All of them, in a fixed order.
  std::vector<FloorEvidence> floorEvidence() const;

  const ClassPosterior& posterior(int class_index) const;
  /// Belief of ground of a class away from any evidence.
  GroundBelief classBelief(int class_index, Classes classes = Classes::AsKnown) const;
  /// States of all classes.
  std::vector<ClassState> states(Classes classes) const;
  /// Boxes of cells, apart from each other, outside of which all ground is believed to be what its class is.
  std::vector<maps::CellBox> reached() const;

  static constexpr double kPoseReach = 2.0;  ///< standard deviations of the pose that a bound reaches

  /// Side of a block.
  int blockCells() const noexcept;

  /// All evidence in a fixed order, as a file keeps it, and putting it back into a field of the same site: the cells
  /// whose belief that may change, as add(); nothing where the site has no such block or class.
  void visit(const std::function<void(const SavedBlock&)>& visit) const;
  std::optional<maps::CellBox> restore(const SavedBlock& saved);

  /// What it is made of, for EvidenceBeliefs.
  const EvidenceStore& store() const noexcept { return *store_; }

 private:
  bool teachesClass(std::uint16_t level) const noexcept {
    return level == BlockEvidence::kTop || site_->classes.empty();
  }
  BlockLevel levelOf(maps::Cell cell, const Floor& floor) const;
  bool standsOnOneClass(const WheelObservation& observation, int class_index) const;
  enum class Count { Add, TakeOff };
  maps::CellBox hear(const BlockLevel& where, const SavedBlock& heard, Count how = Count::Add);
  BlockContribution lessonOf(const BlockEvidence& block, int class_index) const;
  std::vector<BlockContribution> lessonsOf(const BlockLevel& where, const BlockEvidence& block,
                                           int class_index) const;
  Estimate priorOf(int class_index) const;
  std::optional<float> squareStrength(const std::pair<int, int>& square, int class_index) const;
  ClassState stateOf(int class_index, Classes classes = Classes::AsKnown) const;

  std::shared_ptr<const GroundSite> site_;
  std::unique_ptr<EvidenceStore> store_;
};

}  // namespace talus::costmap
