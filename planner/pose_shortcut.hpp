#pragma once

#include <planner/pose_path.hpp>

namespace talus::planner {

/// The same drive with every stretch replaced by the direct curve between its ends where that is cheaper
/// under the exact cost; never dearer than what came in. The longest stretches are tried first.
PosePath shortened(const PosePath& path, const PoseCost& cost);

}  // namespace talus::planner
