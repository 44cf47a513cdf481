#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Headings at the start and at the goal of a drive; empty: any heading.
struct EndHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// Returns the cheapest drive of straight legs and turns in place along a polyline, for a rover that can turn
/// in place. The drive leads through some of the points in order, forward or in reverse, and its cost
/// includes all turns and stops. The method is dynamic programming over pairs of points up to 48 apart. The
/// drive has no legs if no such drive is allowed.
PosePath turningPath(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost);

/// Parameters of shortened().
struct ShortenOptions {
  /// Spacing of joints (possible ends of curves) along the drive in the first round, > 0; smaller in later
  /// rounds.
  double joint_m = 1.0;
  /// Lower bound of the cost per metre, which excludes curves before their exact cost is computed.
  double cheapest_J_per_m = 0.0;
  StopCheck stop{};  ///< after a stop, the rest of the drive remains as it is
};

/// Replaces sections of a drive (route of arcs and turns in place) by the direct curve between their ends if
/// this curve has a lower exact cost. The method is dynamic programming over joints along the drive, repeated
/// while the cost decreases. The result never costs more than `path`.
PosePath shortened(const PosePath& path, const PoseCost& cost, const ShortenOptions& options);

}  // namespace talus::planner
