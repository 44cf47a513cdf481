#pragma once

#include <vector>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Check of the outermost wheels of a rover at the ends of a route. Along a route the wheels stay within the
/// half width that the map keeps free of hazards; at an end, those of the first and last axle stand up to
/// hypot(wheelbase, track)/2 from the end.

/// Returns the poses at the start and the goal of a polyline, with the headings of its first and last leg;
/// empty for a polyline without length.
std::vector<Pose> endPoses(const std::vector<maps::Point>& route);
/// Returns the poses of a drive at its start and at its goal, including the headings of turns in place there,
/// at most 0.1 rad apart.
std::vector<Pose> endPoses(const PosePath& drive);

/// Returns a violation for each of the poses at which an outermost wheel would stand outside a map whose
/// border the rover must avoid, or on a refused cell with one of the hazards kKeptClearOf by `hazards`
/// (without the function: on an unobserved cell). Empty for a cost function without the outline of the rover
/// (TravelCost::Limits::outline).
std::vector<Violation> violationsAtEnds(const costmap::CostGrid& map, const std::vector<Pose>& ends,
                                        const HazardsOf& hazards = {});

}  // namespace talus::planner
