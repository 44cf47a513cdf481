#pragma once

#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

struct EvidenceStore;

/// The estimate of a piece of ground.
struct InferredGround {
  GroundBelief ground;
  bool learned = false;  ///< evidence nearby moved it away from its class
};

/// The estimate of a place: no better than the class away from evidence until enough places agree, never better than any
/// single weak place implies, and within the bounds of its block. Equal to classGround() to the bit where no evidence
/// reaches it.
InferredGround inferredGround(const EvidenceStore& store, const LocalGround& local, const GroundOfClass& of,
                              const maps::Point& at);

}  // namespace talus::costmap
