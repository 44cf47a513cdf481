#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::planner {

/// Names of the planners on offer, the default first: "field", "hybrid" (drives that keep a turning radius)
/// and OMPL's by their class names.
const std::vector<std::string>& plannerNames();

/// The offered name that the user means: case, '-', '_' and blanks do not matter and "RRT*" is "RRTstar";
/// empty is the default. Throws std::invalid_argument with the reason for a planner of OMPL that is not right
/// on this ground, and for an unknown one with the nearest name, where there is one.
std::string plannerName(std::string_view asked);

}  // namespace talus::planner
