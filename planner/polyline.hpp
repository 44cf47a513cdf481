#pragma once

#include <vector>

#include <maps/grid.hpp>

namespace talus::planner {

/// The same polyline with every leg cut into equal parts of at most longest_m metres, > 0.
std::vector<maps::Point> subdivided(const std::vector<maps::Point>& points, double longest_m);

}  // namespace talus::planner
