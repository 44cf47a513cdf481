#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

#include <talus/common/common.hpp>

namespace talus {

/// Calls each(k) for k = 0 ... count - 1 on `threads` threads, one of which is the calling thread. Calls for
/// different k must be independent. The first exception stops the loop; the exception is rethrown in the
/// calling thread after the calls in progress have finished.
template <typename Each>
void parallelFor(std::size_t count, int threads, Each each) {
  std::atomic<std::size_t> next{0};
  std::atomic_flag failed;
  std::exception_ptr failure;
  const auto work = [&]() noexcept {
    for (std::size_t k = next++; k < count; k = next++) try {
        each(k);
      } catch (...) {
        next = count;
        if (!failed.test_and_set()) failure = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < threads && static_cast<std::size_t>(k) < count; ++k) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Range [first, past) of raster rows.
struct Rows {
  int first = 0;
  int past = 0;  ///< one beyond the last row of the range
};

/// Number of rows and threads of a loop by forEachStrip().
struct RowWork {
  int rows = 0;     ///< number of raster rows, >= 0
  int threads = 1;  ///< number of threads, >= 1
};

/// Calls work(Rows) once for each strip of 64 raster rows by parallelFor(). Only the calling thread reports progress to
/// `watch`. After a stop request, strips not yet started are skipped.
template <typename Work>
void forEachStrip(const RowWork& what, const ProgressMonitor& watch, Work work) {
  constexpr int kStripRows = 64;
  const int strips = (what.rows + kStripRows - 1) / kStripRows;
  const auto caller = std::this_thread::get_id();
  parallelFor(static_cast<std::size_t>(strips), what.threads, [&](std::size_t k) {
    if (watch.stopped()) return;
    const int first = static_cast<int>(k) * kStripRows;
    work(Rows{first, std::min(first + kStripRows, what.rows)});
    if (std::this_thread::get_id() == caller) watch.report((static_cast<double>(k) + 1.0) / strips);
  });
}

}  // namespace talus
