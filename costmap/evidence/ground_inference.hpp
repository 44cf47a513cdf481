#pragma once

#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// Estimate of the ground at a place.
struct InferredGround {
  GroundBelief ground;
  bool learned = false;  ///< true if nearby evidence changed the estimate from that of the class
};

/// Returns the estimate of the ground at `at`. Without ClassState::may_raise, the estimate does not exceed
/// that of the class without evidence. The estimate never exceeds the value that any single weak place
/// implies, and lies within the bounds of its block. The estimate is bitwise equal to classGround() where no
/// evidence reaches `at`.
InferredGround inferredGround(const EvidenceStore& store, const LocalGround& local, const GroundOfClass& of,
                              const maps::Point& at);

}  // namespace talus::costmap
