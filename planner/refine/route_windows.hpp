#pragma once

#include <functional>

#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// How a route is cut for work on its parts.
struct WindowCut {
  double length_m = 0.0;   ///< of a window
  double overlap_m = 0.0;  ///< to each side of where two windows meet, worked on once more
  double reach_m = 0.0;    ///< farthest ground from a window's bounding box that the work looks at
};

/// Gives a way between the same ends, and the same one for the same window on the same ground.
using WindowWork = std::function<Polyline(const Polyline&)>;

/// Works on the windows of a route, then on what lies around the places where two meet, side by side on
/// `threads` threads; the answer does not depend on their number. What the memo holds is not worked on.
/// Windows not begun when stopped stay as they are.
Polyline byWindows(const Polyline& route, const WindowCut& cut, const WindowWork& work, RefinementCache& memo,
                   int threads = 1, const StopCheck& stop = {});

/// The same over windows that are cut already, each beginning where the one before ends.
Polyline overWindows(std::vector<Polyline> windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

/// The second half of it: of windows that were worked on, each beginning where the one before ends.
Polyline joinWindows(const std::vector<Polyline>& windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

}  // namespace talus::planner
