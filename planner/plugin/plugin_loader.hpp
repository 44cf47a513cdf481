#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// A planner from a shared library; the library stays loaded as long as the planner, or one that
/// it created, lives. A field of a request that the planner does not honour is refused, whatever the plugin does.
/// Throws talus::InputError naming the file when it is missing, is no library, exports no `talus_planner`, or
/// was built for another interface version. A child process of 4 GiB loads and unloads it first: a library that ends it,
/// or takes longer than `trial_s` seconds of the clock, > 0, is refused too.
std::unique_ptr<GlobalPlanner> loadPlugin(const std::string& path, double trial_s = 10.0);

}  // namespace talus::planner
