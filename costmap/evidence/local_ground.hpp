#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>

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

/// Computes the estimates of ground of cells. Evidence is collected once for each patch (8x8 blocks) and
/// terrain class. An estimate is computed once for each block (square of cells) and class; it depends only on
/// the class states and on the evidence that can affect the patch. Valid until the field changes. Not
/// thread-safe.
class EvidenceBeliefs {
 public:
  explicit EvidenceBeliefs(const EvidenceField& field);
  ~EvidenceBeliefs();
  EvidenceBeliefs(const EvidenceBeliefs&) = delete;
  EvidenceBeliefs& operator=(const EvidenceBeliefs&) = delete;

  /// Returns the estimate for the top surface of a cell, as ground of a terrain class. The reference is valid
  /// until the next call.
  const InferredGround& at(maps::Cell cell, int class_index);

 private:
  struct Patch;
  using Key = std::tuple<int, int, int>;

  GroundOfClass groundOf(int class_index) const;
  Patch& patchAt(const BlockOfClass& block, int class_index);
  const InferredGround& away(int class_index);

  const EvidenceStore& store_;
  std::vector<ClassState> states_;
  std::map<Key, std::shared_ptr<Patch>> patches_;
  Key last_key_{0, 0, -1};
  Patch* last_ = nullptr;
  std::map<int, InferredGround> away_;  // estimate of each class where no evidence reaches
};

}  // namespace talus::costmap
