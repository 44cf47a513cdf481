#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/refine/route_windows.hpp>
#include <talus/planner/refine/vertices.hpp>

namespace talus::planner {
namespace {

// [cells] Stretches between two marks are refined and cached as a whole, then the surroundings of the marks:
// smallest distance of marks, and overlap at each mark.
constexpr double kMarks = 96.0, kAround = 20.0;

// [cells] Distance from a section of the ground on which its refinement depends.
constexpr double kNear = 38.0;

// [cells] Longest window of a search, because a search needs memory for a window's bounding box. Marks are
// turns, and long straight legs have none.
constexpr double kWindow = 256.0;

// Relative gain expected from sliding the turns, because the search crosses edges at a few points only.
constexpr double kSlidingGains = 0.03;

}  // namespace

Polyline Refiner::acrossEdges(const MotionCost& cost, const CorridorSearch& search,
                              const Polyline& window) const {
  const double before_J = cost.along(window);
  EdgePath path = search(window, before_J * (1.0 + kSlidingGains));
  if (path.empty()) return window;
  slideTurns(cost.map(), path, 0.5 / options_.corridor.points_per_edge, options_.slides);
  Polyline tried = path.points(cost.map().grid());
  tried.front() = window.front();
  tried.back() = window.back();
  return cost.along(tried) < before_J ? tried : window;
}

Polyline Refiner::refinedStretch(const MotionCost& cost, const CorridorSearch& search, Polyline stretch,
                                 const StopCheck& stop) const {
  const double cell_m = cost.map().grid().resolution_m;
  double best_J = cost.along(stretch);
  const auto take = [&](Polyline tried) {
    const double tried_J = cost.along(tried);
    if (!(tried_J < best_J)) return;
    best_J = tried_J;
    stretch = std::move(tried);
  };
  RefinementCache none;
  take(byWindows(
      stretch, {kWindow * cell_m, kAround * cell_m},
      [&](const Polyline& window) { return acrossEdges(cost, search, window); }, none, 1, stop));
  take(withFewerTurns(cost, stretch));
  return stretch;
}

Polyline Refiner::operator()(const MotionCost& cost, Polyline route, int threads, const StopCheck& stop) {
  memo_.newRound();
  if (route.size() < 2) return route;
  const double cell_m = cost.map().grid().resolution_m;
  double best_J = cost.along(route);
  const auto take = [&](Polyline tried) {
    const double tried_J = cost.along(tried);
    if (!(tried_J <= best_J)) return;
    best_J = tried_J;
    route = std::move(tried);
  };
  const CorridorSearch search(cost, options_.corridor);
  const WindowCut cut{kMarks * cell_m, kAround * cell_m, kNear * cell_m};
  take(overWindows(
      cutAtMarks(route, cut.length_m), cut,
      [&](const Polyline& stretch) { return refinedStretch(cost, search, stretch, stop); }, memo_, threads,
      stop));
  take(withFewerTurns(cost, withLongerTacks(cost, route)));
  return route;
}

}  // namespace talus::planner
