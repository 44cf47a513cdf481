#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::planner {

/// Names of the available planners, default first: "field", "hybrid" (drives with a turning radius), and
/// OMPL's planners by class name.
const std::vector<std::string>& plannerNames();

/// Canonical planner name for user input: ignores case, '-', '_' and blanks; "RRT*" is "RRTstar"; empty is
/// the default. Throws std::invalid_argument with the reason for an OMPL planner that is unsuitable for this
/// ground, and with the nearest name, if any, for an unknown planner.
std::string plannerName(std::string_view asked);

}  // namespace talus::planner
