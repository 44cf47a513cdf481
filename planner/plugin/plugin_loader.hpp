#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Creates the planner of a shared library. The library stays loaded for the lifetime of the planner and of
/// planners that it created. Fields of a request that the planner does not honour are refused before the
/// plugin is called. Throws talus::InputError with the file name if the file is missing, is not a library,
/// exports no `talus_planner`, or was built for another interface version. The library is first loaded and
/// unloaded in a child process of 4 GiB and refused if it ends the process or takes longer than `trial_s` > 0
/// seconds of wall time.
std::unique_ptr<GlobalPlanner> loadPlugin(const std::string& path, double trial_s = 10.0);

}  // namespace talus::planner
