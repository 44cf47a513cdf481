#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>

namespace talus {

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

/// Calls work(strip) once for each strip of 64 raster rows, on `what.threads` threads including the calling
/// thread. Only the calling thread reports progress to `watch`. After a stop request, strips not yet started
/// are skipped. The first exception of `work` is rethrown in the calling thread.
void forEachStrip(const RowWork& what, const ProgressMonitor& watch, const std::function<void(Rows)>& work);

}  // namespace talus
