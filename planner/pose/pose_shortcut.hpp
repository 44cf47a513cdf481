#pragma once

#include <talus/planner/route/pose_path.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

struct ShortenOptions {
  double joint_m = 1.0;           ///< spacing of joints in the first round, > 0; later rounds are finer
  double cheapest_J_per_m = 0.0;  ///< lower bound of the cost per metre; excludes curves before their exact
                                  ///< cost is computed
  StopCheck stop{};               ///< a stop keeps the rest of the drive as it is
};

/// Replaces stretches of a drive by the direct curve between their ends if the curve is cheaper under the
/// exact cost. Dynamic programming over joints along the drive, repeated while the cost decreases. The result
/// never costs more than `path`.
PosePath shortened(const PosePath& path, const PoseCost& cost, const ShortenOptions& options);

}  // namespace talus::planner
