#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// Headings at the ends of a drive; empty: any heading.
struct EndHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// Cheapest drive of straight legs and turns in place along a polyline, for a rover that can turn in place:
/// through some of the points in order, forward or in reverse, including the costs of all turns and stops.
/// Dynamic programming over pairs of points up to 48 apart. Has no legs if no such drive is allowed.
PosePath turningPath(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost);

}  // namespace talus::planner
