#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include <boost/dll/shared_library.hpp>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/plugin/child_process.hpp>

namespace talus::planner {

/// Maximum length of a text from a plugin [characters].
inline constexpr std::size_t kLongestPluginText = 1000;

/// Memory limit of a child process for a plugin, in addition to the memory of the program [bytes].
inline constexpr std::uint64_t kMostPluginMemory = std::uint64_t{4} << 30;

/// The following functions are shared by planner plugins and layer plugins, for loading (plugin_loader.cpp)
/// and for execution (plugin_planner.cpp).

/// Opens the shared library with the given path. Throws InputError with the file name if the file is missing
/// or cannot be loaded.
boost::dll::shared_library openedLibrary(const std::string& path);

/// Returns text of a plugin, which is not trusted, as one line of at most kLongestPluginText characters.
std::string oneLine(std::string text);

/// Throws the InputError for a plugin that violates the interface; `what` describes the violation.
[[noreturn]] void failPlugin(const std::string& file, const std::string& what);

/// Redirects the output of this process and of the dynamic linker to /dev/null.
void silenceStreams();

/// Runs `work`, which calls a plugin, in a child process and returns its result. The first byte of the result
/// is a type code other than 'i' and 'x'. Output of the plugin is discarded. The result is empty after a
/// stop. Throws InputError with the file name if the work throws, crashes, exceeds a limit or returns
/// nothing.
std::string answerOf(const std::string& file, const std::function<std::string()>& work,
                     const ChildLimits& limits, const ProgressMonitor& watch);

}  // namespace talus::planner
