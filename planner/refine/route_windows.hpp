#pragma once

#include <functional>

#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Parameters for the division of a route into windows (consecutive sections).
struct WindowCut {
  double length_m = 0.0;   ///< length of a window
  double overlap_m = 0.0;  ///< length, on both sides of a joint of two windows, that is refined again
  /// Distance from the bounding box of a window up to which ground affects the result of the work.
  double reach_m = 0.0;
};

/// Function that returns a path with the same ends as its argument. The result must depend only on the
/// argument and the ground.
using WindowWork = std::function<Polyline(const Polyline&)>;

/// Applies `work` to the windows of a route, then to the surroundings of the joints between windows, with
/// `threads` threads; the result does not depend on their number. Windows whose results are in `memo` are not
/// processed again. After a stop, windows that were not started remain unchanged.
Polyline byWindows(const Polyline& route, const WindowCut& cut, const WindowWork& work, RefinementCache& memo,
                   int threads = 1, const StopCheck& stop = {});

/// Performs byWindows() for windows that are already cut; each window begins at the end of the previous
/// window.
Polyline overWindows(std::vector<Polyline> windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

/// Performs the second step of overWindows(): processes the surroundings of the joints and joins the windows.
/// Each window begins at the end of the previous window.
Polyline joinWindows(const std::vector<Polyline>& windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

}  // namespace talus::planner
