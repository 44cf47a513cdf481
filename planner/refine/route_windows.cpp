#include <algorithm>
#include <bit>
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
