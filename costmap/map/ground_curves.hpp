#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/evidence/local_ground.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/ground/wheel_swath.hpp>
#include <talus/costmap/site/surface_patch.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

class TraversabilityMap;

/// Computes the estimates of the cells of a map from its surface, evidence and published categories. Data
/// common to adjacent cells are cached. Valid until the map changes. Not thread-safe.
class PlaceBeliefs {
 public:
  explicit PlaceBeliefs(const TraversabilityMap& map);

  /// Returns the estimate of a cell inside the map.
  CellBelief at(maps::Cell cell);
  /// Returns the estimated strength of a cell's ground, from the prior of the terrain class and the evidence;
  /// nullopt for a cell without a class.
  std::optional<GroundBelief> ground(maps::Cell cell);

 private:
  const TraversabilityMap& map_;
  EvidenceBeliefs beliefs_;
};

/// Assigns an index of a cost curve (cost per metre over the gradient) to each cell. If all ground that a
/// wheel may touch has the same estimated strength, the curve is that of the cell's ground; otherwise it is
/// that of the ground combined by WheelSwath. Stores the learned ground of cells rounded, and
/// recomputes cells only after changes within reach of the wheels. Not thread-safe.
class GroundCurves {
 public:
  explicit GroundCurves(std::shared_ptr<const GroundSite> site);

  const CostCurveTable& table() const noexcept { return table_; }

  /// Returns the curve index of a cell whose terrain class has a soil. Returns CellCode::kUnknown if a wheel
  /// may touch ground without a class and the policy excludes unknown ground.
  CellCode::Curve number(maps::Cell cell);
  /// Returns the curve index of an unobserved cell that the policy allows, as ground of the first class.
  CellCode::Curve numberOfUnseen(maps::Cell cell) { return withLayers(table_.prior(0), cell); }

  /// Changes made by learnClasses().
  struct ClassChange {
    bool priors = false;   ///< true if the prior of a terrain class changed
    bool learned = false;  ///< true if the state of a class changed from which learned ground was computed
  };
  /// Updates the estimates of the terrain classes from the evidence.
  ClassChange learnClasses(const EvidenceField& field);
  /// Updates the estimates of the cells of the boxes `ranges`. Returns the boxes of cells whose curve indices may have changed.
  std::vector<maps::CellBox> learn(EvidenceBeliefs& beliefs, const std::vector<maps::CellBox>& ranges);

  /// Reads the changed terrain classes of the site in a box. Returns the box of cells whose curve indices may
  /// have changed.
  maps::CellBox takeClasses(const maps::CellBox& box);

  /// Returns boxes that contain all cells whose curve is combined from ground of different strengths.
  std::vector<maps::CellBox> mixedRanges() const;

  /// Discards the curve indices of all estimates from telemetry and of cost layers.
  void restart() { table_.restart(); }

 private:
  WheelSwath::Ground ground(maps::Cell cell) const;
  std::uint32_t wordOf(const GroundBelief& ground, int class_index);
  CellCode::Curve numberOfGround(maps::Cell cell);
  CellCode::Curve withLayers(CellCode::Curve number, maps::Cell cell);
  bool alike(maps::Cell cell) const noexcept;
  maps::CellBox within(const maps::CellBox& range) const noexcept;

  std::shared_ptr<const GroundSite> site_;
  CostCurveTable table_;
  AddedCost added_;
  WheelSwath swath_;
  std::vector<bool> borders_;
  LearnedCells learned_;                                  // 1 + index in kinds_
  std::vector<GroundBelief> kinds_;                       // distinct rounded estimates of learned cells
  std::map<std::array<double, 4>, std::uint32_t> words_;  // of the numbers of a kind
  std::vector<ClassState> states_;                        // class states from which learned_ was computed
  bool any_learned_ = false;
  std::vector<WheelSwath::Ground> around_;
};

}  // namespace talus::costmap
