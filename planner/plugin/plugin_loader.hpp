#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Loads the shared library `path` and creates its planner. The library stays loaded for the lifetime of the
/// planner and of all planners that it created. If a field of a request is set that the planner does not
/// support, an exception is thrown before the plugin is called (request_check.hpp). Throws talus::InputError
/// with the file name if the file is missing, is not a library, exports no `talus_planner`, or was built for
/// another interface version. The library is first loaded and unloaded in a child process with a memory limit
/// of 4 GiB. InputError is also thrown if this trial crashes or takes longer than `trial_s` > 0 seconds of
/// wall time.
std::unique_ptr<GlobalPlanner> loadPlugin(const std::string& path, double trial_s = 10.0);

}  // namespace talus::planner
