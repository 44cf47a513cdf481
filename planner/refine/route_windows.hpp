#pragma once

#include <functional>

#include <talus/planner/refine/refinement_cache.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Division of a route into windows.
struct WindowCut {
  double length_m = 0.0;   ///< length of a window
  double overlap_m = 0.0;  ///< to each side of a joint of two windows, refined once more
  double reach_m = 0.0;    ///< largest distance from a window's bounding box of the ground used by the work
};

/// Returns a path between the same ends; must be a function of the window and the ground only.
using WindowWork = std::function<Polyline(const Polyline&)>;

/// Applies `work` to the windows of a route, then to the surroundings of the joints, with `threads` threads;
/// the result does not depend on their number. Windows in the cache are not processed again. Windows not
/// started when stopped are left unchanged.
Polyline byWindows(const Polyline& route, const WindowCut& cut, const WindowWork& work, RefinementCache& memo,
                   int threads = 1, const StopCheck& stop = {});

/// byWindows() for windows already cut, each beginning at the end of the previous one.
Polyline overWindows(std::vector<Polyline> windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

/// Second step of overWindows(): joins processed windows, each beginning at the end of the previous one.
Polyline joinWindows(const std::vector<Polyline>& windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads = 1, const StopCheck& stop = {});

}  // namespace talus::planner
