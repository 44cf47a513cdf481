#pragma once

#include <talus/planner/planner.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route on a map that does not fit in memory. The route over the overview is the guide of each leg.
/// The leg is planned in parts along the guide, each by FieldPlanner on the cells near the part, and once more
/// across the joints of the parts. The route may differ from that of FieldPlanner on the whole map if the guide
/// does not follow the best corridor; the lower bound is that of the straight line. The status NoneFound is no
/// proof. Deterministic for any number of threads. Replaces problem.map by the map of the last leg.
Plan planInWindows(Problem& problem, WindowedMap& map);

}  // namespace talus::planner
