#include <algorithm>
#include <thread>

#include <talus/common/parallel_for.hpp>
#include <talus/common/parallel_rows.hpp>

namespace talus {

void forEachStrip(const RowWork& what, const ProgressMonitor& watch, const std::function<void(Rows)>& work) {
  constexpr int kStripRows = 64;
  const int strips = (what.rows + kStripRows - 1) / kStripRows;
  const auto caller = std::this_thread::get_id();
  parallelFor(static_cast<std::size_t>(strips), what.threads, [&](std::size_t k) {
    if (watch.stopped()) return;
    const int first = static_cast<int>(k) * kStripRows;
    work({first, std::min(first + kStripRows, what.rows)});
    if (std::this_thread::get_id() == caller) watch.report((static_cast<double>(k) + 1.0) / strips);
  });
}

}  // namespace talus
