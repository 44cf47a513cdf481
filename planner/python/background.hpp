#pragma once

#include <functional>

#include <pybind11/pybind11.h>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// Runs `work` in a separate thread without the GIL. Meanwhile the calling thread checks for Ctrl-C 20 times
/// per second and calls `progress` (may be None) with the completed share of the work, [0, 1]. Ctrl-C or an
/// exception of `progress` requests a stop of the work; the exception is rethrown after the work has ended.
/// Exceptions of the work are also rethrown.
void inBackground(const std::function<void(const ProgressMonitor&)>& work, const pybind11::object& progress);

}  // namespace talus::planner
