#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::planner {

/// Returns the names of the available planners, the default first: "field" (polylines from a cost-to-go
/// field), "hybrid" (drives with a turning radius), and the planners of OMPL by their class names.
const std::vector<std::string>& plannerNames();

/// Returns the canonical planner name for the user input `asked`. The comparison ignores case, '-', '_' and
/// blanks; "RRT*" means "RRTstar"; empty input means the default. Throws std::invalid_argument with the
/// reason for an OMPL planner that is not suitable for this application, and with the most similar name, if
/// any, for an unknown planner.
std::string plannerName(std::string_view asked);

}  // namespace talus::planner
