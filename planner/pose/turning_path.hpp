#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/pose_path.hpp>

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

}  // namespace talus::planner
