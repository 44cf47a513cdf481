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

/// All readings of one terrain class in a block, as map files store them.
struct SavedBlock {
  BlockOfClass block;
  /// Telemetry time of the newest reading, rounded down [s].
  std::uint32_t updated_s = 0;
  std::uint8_t reach = 0;  ///< position uncertainty of the readings, in steps of 0.1 m
  std::vector<ReadingCount> counts;
};

struct ClassState;
struct EvidenceStore;

/// Evidence of a map: wheel observations by place. Evidence is stored by block and terrain class. A block is
/// a square of cells (BlockGrid). A Gaussian process over the class mean extends the evidence to nearby
/// ground of the same class, and each class has a posterior.
///
/// Blocks have a side of a quarter of the correlation length, so that the work for an observation does not
/// depend on the map's resolution. The same evidence in any order gives bit-identical results. Not
/// thread-safe while changed.
class EvidenceField {
 public:
  /// Makes a field without evidence.
  explicit EvidenceField(std::shared_ptr<const GroundSite> site);
  ~EvidenceField();
  EvidenceField(EvidenceField&&) noexcept;
  EvidenceField& operator=(EvidenceField&&) noexcept;

  /// Adds an observation. Returns the box of cells whose estimate may change while the class states are
  /// constant: all cells of the patches of blocks that the observation can affect. Returns nullopt if the
  /// observation lies outside the map or on ground without a class, or if it contains neither an estimate nor
  /// a bound.
  std::optional<maps::CellBox> add(const WheelObservation& observation);
  /// Returns the block and the quantised readings that add() would store for an observation; nullopt if add()
  /// would return nullopt.
  std::optional<SavedBlock> readingsOf(const WheelObservation& observation) const;
  /// Removes stored readings. Returns the box of cells whose estimate may change; nullopt if the block has no
  /// evidence.
  std::optional<maps::CellBox> forget(const SavedBlock& readings);

  /// Returns the evidence of the block that contains a cell, for the cell's class; null without evidence.
  const BlockEvidence* evidence(maps::Cell cell) const noexcept;
  /// Returns the number of pull readings of the evidence, each weighted by (0.05/std)^2 [-].
  double samplesOf(maps::Cell cell) const;

  /// Returns the estimate for ground of a class without nearby evidence.
  GroundBelief classBelief(int class_index) const;
  /// Returns the states of all classes, in the order of GroundModel::Parts::classes.
  std::vector<ClassState> states() const;
  /// Returns disjoint boxes of cells that evidence can affect; ground outside these boxes has the estimate of
  /// its class.
  std::vector<maps::CellBox> reached() const;

  /// Radius within which a bound applies, in standard deviations of the position [-].
  static constexpr double kPoseReach = 2.0;

  /// Returns the side length of a block [cells].
  int blockCells() const noexcept;

  /// visit() calls `visit` with all evidence in a fixed order. restore() adds such evidence to a field of the
  /// same site, and returns the box of cells whose estimate may change; nullopt if the site has no such block
  /// or class.
  void visit(const std::function<void(const SavedBlock&)>& visit) const;
  std::optional<maps::CellBox> restore(const SavedBlock& saved);

  /// Returns the data of the field, for EvidenceBeliefs.
  const EvidenceStore& store() const noexcept { return *store_; }

 private:
  bool standsOnOneClass(const WheelObservation& observation, int class_index) const;
  enum class Count { Add, TakeOff };
  maps::CellBox count(const BlockOfClass& where, const SavedBlock& readings, Count how = Count::Add);
  ClassState stateOf(int class_index) const;

  std::shared_ptr<const GroundSite> site_;
  std::unique_ptr<EvidenceStore> store_;
};

}  // namespace talus::costmap
