#pragma once

#include <functional>

#include <pybind11/pybind11.h>

#include <talus/common/progress_monitor.hpp>

namespace talus::planner {

/// Runs work in a thread of its own without the GIL. The calling thread looks meanwhile, 20 times a second, for Ctrl-C and
/// calls `progress` (may be None) with the share done, 0 to 1: what either raises stops the work and is raised once that
/// has ended. What the work throws is thrown on.
void inBackground(const std::function<void(const ProgressMonitor&)>& work, const pybind11::object& progress);

}  // namespace talus::planner
