#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

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
