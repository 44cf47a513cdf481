#include <utility>

#include <talus/common/parallel_for.hpp>
#include <talus/planner/refine/route_windows.hpp>

namespace talus::planner {
namespace {

struct Job {
  const WindowCut& cut;
  const WindowWork& work;
  RefinementCache& memo;
  int threads;
  const StopCheck& stop;
};

void workOn(Polyline& window, const Job& job) {
  if (job.stop()) return;
  const Polyline key = window;
  if (auto known = job.memo.find(key)) {
    window = std::move(*known);
    return;
  }
  window = job.work(window);
  if (!job.stop()) job.memo.keep(key, window, job.cut.reach_m);
}

void workOnAll(std::vector<Polyline>& windows, const Job& job) {
  parallelFor(windows.size(), job.threads, [&](std::size_t k) { workOn(windows[k], job); });
}

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

}  // namespace

Polyline byWindows(const Polyline& route, const WindowCut& cut, const WindowWork& work, RefinementCache& memo,
                   int threads, const StopCheck& stop) {
  return overWindows(cutFromEnd(route, cut.length_m, cut.length_m), cut, work, memo, threads, stop);
}

Polyline overWindows(std::vector<Polyline> windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads, const StopCheck& stop) {
  workOnAll(windows, {cut, work, memo, threads, stop});
  return joinWindows(windows, cut, work, memo, threads, stop);
}

Polyline joinWindows(const std::vector<Polyline>& windows, const WindowCut& cut, const WindowWork& work,
                     RefinementCache& memo, int threads, const StopCheck& stop) {
  if (windows.size() == 1) return windows.front();
  std::vector<Polyline> joints{{}}, middles;
  for (const Polyline& window : windows) {
    Parts parts = partsOf(window, cut.overlap_m);
    append(joints.back(), parts.head);
    middles.push_back(std::move(parts.middle));
    joints.push_back(std::move(parts.tail));
  }
  workOnAll(joints, {cut, work, memo, threads, stop});
  Polyline whole = joints.front();
  for (std::size_t k = 0; k < middles.size(); ++k) {
    append(whole, middles[k]);
    append(whole, joints[k + 1]);
  }
  return whole;
}

}  // namespace talus::planner
