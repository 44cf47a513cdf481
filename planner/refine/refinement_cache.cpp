#include <algorithm>
#include <bit>

#include <talus/planner/refine/refinement_cache.hpp>

namespace talus::planner {

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

}  // namespace talus::planner
