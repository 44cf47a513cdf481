#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/refine/vertices.hpp>

namespace talus::planner {

namespace {

// Windows (consecutive sections) of a route, and their refinement.
struct WindowCut {
  double overlap_m;      // length, on both sides of a joint of two windows, that is refined again
  double reach_m = 0.0;  // distance from the bounding box of a window up to which ground affects the result
};

// Returns a path with the same ends as its argument, which depends only on the argument and the ground.
using WindowWork = std::function<Polyline(const Polyline&)>;

// Head and tail of a window, at most end_m long, and the stretch between them.
struct Parts {
  Polyline head, middle, tail;
};

Parts partsOf(const Polyline& window, double end_m) {
  const double whole_m = length_m(window);
  const bool middle = whole_m > 3 * end_m;
  auto [before, tail] = splitAt(window, middle ? end_m : whole_m / 2);
  if (!middle) return {before, {tail.front()}, tail};
  auto [head, rest] = splitAt(before, whole_m - 2 * end_m);
  return {head, rest, tail};
}

// Applies `work` to windows, each of which begins at the end of the previous one, then to the surroundings of the joints
// between them, and joins them; the result does not depend on the number of threads. Windows whose results are in
// `memo` are not processed again. After a stop, windows that were not started remain unchanged.
Polyline overWindows(std::vector<Polyline> windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads, const StopCheck& stop) {
  const auto workOnAll = [&](std::vector<Polyline>& all) {
    parallelFor(all.size(), threads, [&](std::size_t k) {
      if (stop()) return;
      const Polyline key = all[k];
      const auto known = memo.find(key);
      all[k] = known ? *known : work(key);
      if (!known && !stop()) memo.keep(key, all[k], cut.reach_m);
    });
  };
  workOnAll(windows);
  if (windows.size() == 1) return windows.front();
  std::vector<Polyline> joints{{}}, middles;
  for (const Polyline& window : windows) {
    Parts parts = partsOf(window, cut.overlap_m);
    append(joints.back(), parts.head);
    middles.push_back(std::move(parts.middle));
    joints.push_back(std::move(parts.tail));
  }
  workOnAll(joints);
  Polyline whole = joints.front();
  for (std::size_t k = 0; k < middles.size(); ++k) {
    append(whole, middles[k]);
    append(whole, joints[k + 1]);
  }
  return whole;
}

}  // namespace

std::size_t RefinementCache::Hash::operator()(const Polyline& window) const noexcept {
  std::uint64_t hash = window.size();
  const auto mix = [&hash](double value) {
    hash ^= std::bit_cast<std::uint64_t>(value);
    hash = hash * 0x9e3779b97f4a7c15U + 1;
    hash ^= hash >> 32;
  };
  for (const maps::Point p : window) mix(p.x_m), mix(p.y_m);
  return hash;
}

std::optional<Polyline> RefinementCache::find(const Polyline& window) {
  const std::lock_guard lock(mutex_);
  const auto known = known_.find(window);
  if (known == known_.end()) return std::nullopt;
  known->second.round = round_;
  return known->second.result;
}

void RefinementCache::keep(const Polyline& window, const Polyline& result, double reach_m) {
  maps::Point low = window.front(), high = low;
  for (const maps::Point p : window) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  low = {low.x_m - reach_m, low.y_m - reach_m};
  high = {high.x_m + reach_m, high.y_m + reach_m};
  const std::lock_guard lock(mutex_);
  known_.insert_or_assign(window, Entry{result, low, high, round_});
}

void RefinementCache::forget(const Segment& corners) {
  const auto apart = [](double low, double high, double a, double b) {
    return high < std::min(a, b) || low > std::max(a, b);
  };
  std::erase_if(known_, [&](const auto& one) {
    const Entry& entry = one.second;
    return !apart(entry.low.x_m, entry.high.x_m, corners.from.x_m, corners.to.x_m) &&
           !apart(entry.low.y_m, entry.high.y_m, corners.from.y_m, corners.to.y_m);
  });
}

void RefinementCache::newRound() {
  std::erase_if(known_, [this](const auto& one) { return one.second.round < round_; });
  ++round_;
}

namespace {

// [cells] Stretches between two marks are refined and cached as a whole, then the surroundings of the marks:
// smallest distance of marks, and overlap at each mark.
constexpr double kMarks = 96.0, kAround = 20.0;

// [cells] Distance from a section of the ground on which its refinement depends: two searches, and shifts.
constexpr double kNear = 78.0;

// [cells] Longest window of a search, because a search needs memory for a window's bounding box. Marks are
// turns, and long straight legs have none.
constexpr double kWindow = 256.0;

// Relative gain expected from sliding the turns, because the search crosses edges at a few points only.
constexpr double kSlidingGains = 0.03;

}  // namespace

Polyline Refiner::acrossEdges(const MotionCost& cost, const PointSearch& search,
                              const Polyline& window) const {
  const double before_J = cost.along(window);
  const auto reach_cells = [&](maps::Cell cell) {
    return search.free(cost.map().at(cell)) ? options_.reach_cells : options_.detour_cells;
  };
  PointPath path =
      search({.places = {window.front(), window.back()}, .below_J = before_J * (1.0 + kSlidingGains)},
             SearchRegion(cost.map().grid(), window, reach_cells));
  if (path.points.empty()) return window;
  const auto held = slideTurns(cost.map(), path, 0.5 / options_.points_per_side, options_.slides);
  Polyline tried = offSides(cost, std::move(path.points));
  if (!held.empty()) tried = withSettledVertices(cost, std::move(tried), {}, held);
  return cost.along(tried) < before_J ? tried : window;
}

Polyline Refiner::refinedStretch(const MotionCost& cost, const PointSearch& search, Polyline stretch,
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
  take(overWindows(
      cutFromEnd(stretch, kWindow * cell_m, kWindow * cell_m), {kAround * cell_m},
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
  const PointSearch search(cost, {.side = options_.points_per_side});
  take(overWindows(
      cutAtMarks(route, kMarks * cell_m), {kAround * cell_m, kNear * cell_m},
      [&](const Polyline& stretch) { return refinedStretch(cost, search, stretch, stop); }, memo_, threads,
      stop));
  take(withFewerTurns(cost, withLongerTacks(cost, route)));
  return route;
}

}  // namespace talus::planner
