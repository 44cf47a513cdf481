#pragma once

#include <optional>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence_bricks.hpp>
#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// Estimated strength of the ground at a place.
struct InferredGround {
  GroundBelief ground;
  bool learned = false;  ///< true if nearby evidence made the estimate different from that of the class
};

/// Bounds of the ground in a block (square of cells), independent of all other evidence. NaN: no bound.
struct PlaceBound {
  maps::Point block;           ///< centre of the block
  double reach_m = 0.0;        ///< position uncertainty of the readings [m]
  double most_pull = 0.0;      ///< upper bound of drawbar pull over load [-]
  double least_sinkage = 0.0;  ///< lower bound of sinkage over radius [-]
};

/// Index of a terrain class, and the state of the class after all evidence.
struct GroundOfClass {
  int class_index = 0;
  ClassState state{};
};

/// Returns the estimate for ground of a class without nearby evidence.
GroundBelief classGround(const GroundModel& model, const GroundOfClass& of);

/// Evidence that can affect the ground of one terrain class in one patch of 8x8 blocks: for each hypothesis of
/// the class, one Gaussian process over the readings of the sound sources. Immutable.
///
/// A hypothesis of a class mean D with standard deviations (o, e) of the places not driven and of the sources
/// gives the ground at a place the mean P0 + D + f and the variance
///   var f + (1 - A)^2 o^2 + e^2                                                                         (B6)
/// with the departure f of the process from D, its variance, and the sum A of the weights of the evidence.
/// A place whose reading differs from that field is on another soil with a probability (0.02 before, differences
/// of 0.3), and then has its own reading. The estimate that decisions use is the hypothesis at the 2 % quantile of the mean.
class LocalGround {
 public:
  /// Collects the evidence that can affect the patch with the south-west block `patch`.
  LocalGround(const EvidenceStore& store, const BlockOfClass& patch, const GroundOfClass& of);

  bool empty() const noexcept { return !any_; }
  /// Returns the estimate of the ground at `at`, as ground of the class. It lies within the bounds of its
  /// block, and is bit-identical to classGround() where no evidence affects `at`.
  InferredGround at(const maps::Point& at) const;

 private:
  struct Hypothesis {
    ClassHypothesis of_class;
    std::vector<PlaceEvidence> places;
    GaussianProcess process;
  };
  const EvidenceStore& store_;
  GroundOfClass of_;
  bool any_ = false;
  std::vector<Hypothesis> hypotheses_;
  std::vector<PlaceBound> bounds_;
};

}  // namespace talus::costmap
