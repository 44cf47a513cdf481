#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <talus/costmap/cell_belief.hpp>
#include <talus/costmap/cost_grid.hpp>
#include <talus/costmap/evidence_bricks.hpp>
#include <talus/costmap/floors.hpp>
#include <talus/costmap/ground_model.hpp>
#include <talus/costmap/spreading.hpp>
#include <talus/costmap/surface_cells.hpp>
#include <talus/costmap/wheel_observation.hpp>
#include <talus/maps/elevation_map.hpp>

namespace talus::costmap {

/// The soil posterior of a terrain class: how its mean pull departs from the prior's after all evidence.
struct ClassPosterior {
  Estimate pull;        ///< departure of drawbar pull over load [-]
  Estimate sinkage;     ///< departure of sinkage over radius [-]
  double places = 0.0;  ///< independent places that speak for it [-]
};

/// The ground as it was before anybody drove on it: what a map and its evidence share and never change.
struct GroundSite {
  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;  ///< class numbers; empty: all of the first class
  SurfaceKeys keys;
  std::shared_ptr<const GroundModel> model;
  Floors floors{};  ///< beneath the elevation, which is the top surface

  const maps::Grid& grid() const noexcept { return elevation.grid(); }
  /// Position of a cell's class in the model's classes, or -1 when it has no soil.
  int classIndex(maps::Cell cell) const noexcept {
    return classes.empty() ? 0 : model->classIndex(classes[cell]);
  }
  /// The floor beneath the top surface that a wheel at this height stands on; nothing where it is on top.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return floors.under(grid().index(cell), z_m, static_cast<double>(elevation.elevation_m[cell]));
  }
};

/// What the wheels told, where: blocks of ground with their own evidence, spread to neighbours of the same
/// class by a Gaussian process over the class mean, and a posterior of each class.
///
/// A block is the largest power of two of cells no wider than a quarter of the correlation length, on the
/// octree's own lines, so that a sample's work does not depend on the map's resolution. What was driven
/// beneath an overhang stays on its floor: it tells nothing about the top, and about the first class of
/// ground only where no raster names classes. Same evidence in the same order, same bits. Not thread-safe
/// while changed.
class EvidenceField {
 public:
  explicit EvidenceField(std::shared_ptr<const GroundSite> site);

  /// Takes an observation in and returns the cells whose belief it may change (besides those of the class as
  /// a whole); nothing when the place is outside the map, has no elevation or class, or lies in a block that
  /// was first driven on ground of another class.
  std::optional<maps::CellBox> add(const WheelObservation& observation);

  static constexpr int kPatchBlocks = 8;

  /// What is believed of a piece of ground.
  struct Belief {
    GroundBelief ground;
    bool learned = false;  ///< evidence nearby moved it away from its class
  };

  /// Asked cell by cell: evidence is gathered once a patch of 8x8 blocks and class, a belief is worked out
  /// once a block and class. Valid until the field changes.
  class Beliefs {
   public:
    explicit Beliefs(const EvidenceField& field) : field_(field) {}
    const Belief& at(maps::Cell cell, int class_index);

   private:
    struct Patch {
      GaussianProcess process;
      std::array<std::optional<Belief>, kPatchBlocks * kPatchBlocks> known;
    };
    using Key = std::tuple<int, int, int>;

    Patch& patchAt(const BlockLevel& block, int class_index);
    const Belief& away(int class_index);

    const EvidenceField& field_;
    std::map<Key, Patch> patches_;
    Key last_key_{0, 0, -1};
    Patch* last_ = nullptr;
    std::map<int, Belief> away_;  // from any evidence, a class each
  };

  /// Own evidence of the block that holds the cell, on top; null where nobody drove.
  const BlockEvidence* evidence(maps::Cell cell) const noexcept;
  /// The same of a floor beneath it.
  const BlockEvidence* evidence(maps::Cell cell, const Floor& floor) const;
  /// What is believed of the ground of a floor: its own evidence and that of ground level with it.
  GroundBelief floorBelief(maps::Cell cell, const Floor& floor) const;

  /// Evidence of a floor beneath the top, and a cell that has that floor.
  struct FloorEvidence {
    maps::Cell cell;
    BlockEvidence evidence;
  };
  /// All of them, in a fixed order.
  std::vector<FloorEvidence> floorEvidence() const;

  const ClassPosterior& posterior(int class_index) const {
    return posteriors_[static_cast<std::size_t>(class_index)];
  }
  /// Belief of ground of a class away from any evidence.
  GroundBelief classBelief(int class_index) const;

  int blockCells() const noexcept { return 1 << block_shift_; }

  /// Puts a block's saved evidence back, as read from a file; `level` as in BlockEvidence.
  void restore(maps::Cell cell, std::uint16_t level, const CellBelief& saved);

 private:
  // Exact sums, so that a contribution can be taken out again and order does not matter.
  struct ClassSums {
    std::int64_t weight = 0, pull = 0, sinkage = 0;
  };

  maps::Cell blockOf(maps::Cell cell) const noexcept;
  maps::Point middleOf(maps::Cell block) const noexcept;
  maps::Cell cellOf(const BlockLevel& block) const noexcept;
  int reachBlocks() const noexcept;
  BlockLevel topOf(maps::Cell block) const noexcept;
  BlockLevel levelOf(maps::Cell cell, const Floor& floor) const;
  std::uint16_t keyOf(float height_m) const noexcept;
  std::optional<std::uint16_t> topKey(maps::Cell block) const noexcept;
  void weigh(const WheelObservation& observation, BlockEvidence& block) const;
  void contribute(const BlockEvidence& block, int class_index, std::int64_t sign);
  void refresh(int class_index);
  double measuredVariance(const BlockEvidence& block) const noexcept;
  GaussianProcess process(const BlockLevel& patch, int class_index) const;
  std::vector<PlaceEvidence> levelWith(maps::Cell block, std::uint16_t level) const;
  GaussianProcess processOf(std::vector<PlaceEvidence> found, const maps::Point& middle,
                            int class_index) const;
  PlaceEvidence placed(maps::Cell block, const BlockEvidence& evidence, const GroundBelief& mean) const;
  GroundBelief combined(int class_index, const GroundBelief& departure) const;

  std::shared_ptr<const GroundSite> site_;
  int block_shift_ = 0;
  maps::Cell first_block_;
  EvidenceBricks bricks_;
  std::vector<ClassSums> sums_;
  std::vector<ClassPosterior> posteriors_;
};

}  // namespace talus::costmap
