#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <talus/maps/parallel_rows.hpp>

namespace talus::maps {

void forEachStrip(const RowWork& what, const ProgressMonitor& watch, const std::function<void(Rows)>& work) {
  constexpr int kStripRows = 64;
  const int strips = (what.rows + kStripRows - 1) / kStripRows;
  std::atomic<int> next{0};
  const auto take = [&](bool reports) {
    for (int strip = next++; strip < strips && !watch.stopped(); strip = next++) {
      work({strip * kStripRows, std::min((strip + 1) * kStripRows, what.rows)});
      if (reports) watch.report((strip + 1.0) / strips);
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < std::min(what.threads, strips); ++i) helpers.emplace_back(take, false);
  take(true);
}

}  // namespace talus::maps
