#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>

namespace talus {

/// A range of raster rows [first, past).
struct Rows {
  int first = 0;
  int past = 0;  ///< one beyond the last row
};

/// Size of the loop of forEachStrip().
struct RowWork {
  int rows = 0;
  int threads = 1;  ///< >= 1
};

/// Calls work(strip) once for each strip of 64 rows, on `threads` threads including the calling thread, which
/// alone reports progress. After a stop request, strips not yet started are skipped. The first exception of
/// `work` is rethrown in the calling thread.
void forEachStrip(const RowWork& what, const ProgressMonitor& watch, const std::function<void(Rows)>& work);

}  // namespace talus
