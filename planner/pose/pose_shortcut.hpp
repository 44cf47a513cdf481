#pragma once

#include <talus/planner/route/pose_path.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

struct ShortenOptions {
  double joint_m = 1.0;           ///< between joints of the drive in the first round, > 0; then finer
  double cheapest_J_per_m = 0.0;  ///< no metre costs less; excludes curves before pricing
  StopCheck stop{};               ///< from then on the drive stays as it is
};

/// The same drive with stretches replaced by the direct curve between their ends where that is cheaper under
/// the exact cost: dynamic programming over joints along it, repeated while it gains. Never above the cost of
/// what came in.
PosePath shortened(const PosePath& path, const PoseCost& cost, const ShortenOptions& options);

}  // namespace talus::planner
