#pragma once

#include <optional>
#include <vector>

#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// Headings at the ends of a drive; any where there is none.
struct EndHeadings {
  std::optional<double> start_rad;
  std::optional<double> goal_rad;
};

/// The cheapest drive of straight legs and turns in place that a rover which turns in place can make of a
/// polyline: through some of its points in order, forward or in reverse, every turn and every stop for it
/// priced. Dynamic programming over pairs of points up to 48 apart. No legs where no such drive is allowed.
PosePath turningDrive(const std::vector<maps::Point>& points, const EndHeadings& ends, const PoseCost& cost);

}  // namespace talus::planner
