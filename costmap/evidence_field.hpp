#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <costmap/cost_grid.hpp>
#include <costmap/ground_model.hpp>
#include <costmap/spreading.hpp>
#include <costmap/surface_cells.hpp>
#include <costmap/traversability_tree.hpp>
#include <costmap/wheel_observation.hpp>
#include <maps/elevation_map.hpp>

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

  const maps::Grid& grid() const noexcept { return elevation.grid(); }
  /// Position of a cell's class in the model's classes, or -1 when it has no soil.
  int classIndex(maps::Cell cell) const noexcept {
    return classes.empty() ? 0 : model->classIndex(classes[cell]);
  }
};

/// What the wheels told, where: an OctoMap tree whose leaves are blocks of ground with their own evidence,
/// spread to neighbours of the same class by a Gaussian process over the class mean, and a posterior of each
/// class.
///
/// A block is the largest power of two of cells no wider than a quarter of the correlation length, so that a
/// sample's work does not depend on the map's resolution. Same evidence in the same order, same bits. Not
/// thread-safe while changed.
class EvidenceField {
 public:
  explicit EvidenceField(std::shared_ptr<const GroundSite> site);

  /// Takes an observation in and returns the cells whose belief it may change (besides those of the class as
  /// a whole); nothing when the place is outside the map or has no elevation or class.
  std::optional<CellRange> add(const WheelObservation& observation);

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
    const Belief& away(int class_index);

    using Key = std::tuple<int, int, int>;
    const EvidenceField& field_;
    std::map<Key, GaussianProcess> processes_;
    std::map<Key, Belief> known_;
    std::map<int, Belief> away_;  // from any evidence, a class each
    Key last_{0, 0, -1};
    const Belief* last_belief_ = nullptr;
  };

  /// Own evidence of the block that holds the cell; null where nobody drove.
  const CellBelief* evidence(maps::Cell cell) const;

  const ClassPosterior& posterior(int class_index) const {
    return posteriors_[static_cast<std::size_t>(class_index)];
  }
  /// Belief of ground of a class away from any evidence.
  GroundBelief classBelief(int class_index) const;

  int blockCells() const noexcept { return 1 << block_shift_; }
  bool empty() const noexcept { return tree_.size() == 0; }
  const TraversabilityTree& tree() const noexcept { return tree_; }

  /// Puts a block's saved evidence back, as read from a file.
  void restore(maps::Cell cell, const CellBelief& saved);

 private:
  // Exact sums, so that a contribution can be taken out again and order does not matter.
  struct ClassSums {
    std::int64_t weight = 0, pull = 0, sinkage = 0;
  };

  std::optional<octomap::OcTreeKey> keyOf(maps::Cell cell) const;
  maps::Cell blockOf(maps::Cell cell) const noexcept;
  maps::Point middleOf(maps::Cell block) const noexcept;
  void contribute(const CellBelief& block, int class_index, std::int64_t sign);
  void refresh(int class_index);
  double measuredVariance(const CellBelief& block) const noexcept;
  GaussianProcess process(maps::Cell patch, int class_index) const;
  std::size_t slotOf(maps::Cell block) const noexcept;
  GroundBelief combined(int class_index, const GroundBelief& departure) const;

  std::shared_ptr<const GroundSite> site_;
  int block_shift_ = 0;
  maps::Cell first_block_;
  int block_columns_ = 0;
  std::vector<bool> driven_;  // a block each; spares walking the octree where nobody was
  TraversabilityTree tree_;
  std::vector<ClassSums> sums_;
  std::vector<ClassPosterior> posteriors_;
};

}  // namespace talus::costmap
