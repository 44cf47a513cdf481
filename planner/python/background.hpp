#pragma once

#include <functional>

#include <pybind11/pybind11.h>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// Runs `work` in a separate thread without the GIL. Meanwhile the calling thread checks for Ctrl-C 20 times
/// a second and calls `progress` (may be None) with the completed share, 0 to 1. Ctrl-C or an exception of
/// `progress` stops the work; the exception is raised when the work has ended. Exceptions of the work itself
/// are rethrown.
void inBackground(const std::function<void(const ProgressMonitor&)>& work, const pybind11::object& progress);

}  // namespace talus::planner
