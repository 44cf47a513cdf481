#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>

namespace talus {

/// A strip of a raster's rows.
struct Rows {
  int first = 0;
  int past = 0;  ///< one beyond the last
};

/// How rows are shared out.
struct RowWork {
  int rows = 0;
  int threads = 1;  ///< >= 1
};

/// Calls work(strip) once for each strip of 64 rows, on several threads at once; this thread takes part and
/// alone reports progress. Once a stop is requested the strips not yet begun are left out. The first
/// exception of the work is thrown here.
void forEachStrip(const RowWork& what, const ProgressMonitor& watch, const std::function<void(Rows)>& work);

}  // namespace talus
