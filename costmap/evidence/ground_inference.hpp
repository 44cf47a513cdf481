#pragma once

#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// Estimated strength of the ground at a place.
struct InferredGround {
  GroundBelief ground;
  bool learned = false;  ///< true if nearby evidence made the estimate different from that of the class
};

/// Returns the estimate of the ground at `at`, as ground of the class and class state `of`, from the evidence
/// `local` near `at`. If ClassState::may_raise is false, the estimate does not exceed that of the class
/// without nearby evidence. The estimate never exceeds the value that any single weak place implies, and lies
/// within the bounds of its block. It is bit-identical to classGround() where no evidence affects `at`.
InferredGround inferredGround(const EvidenceStore& store, const LocalGround& local, const GroundOfClass& of,
                              const maps::Point& at);

}  // namespace talus::costmap
