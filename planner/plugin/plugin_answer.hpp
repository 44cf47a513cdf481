#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include <boost/dll/shared_library.hpp>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/plugin/child_process.hpp>

namespace talus::planner {

inline constexpr std::size_t kLongestPluginText = 1000;

/// Largest memory of a child process for a plugin, in addition to the program's own [bytes].
inline constexpr std::uint64_t kMostPluginMemory = std::uint64_t{4} << 30;

/// Functions shared by planner and layer plugins: loading (plugin_loader.cpp) and execution
/// (plugin_planner.cpp).

/// Opens a shared library. Throws InputError with the file name if the file is missing or cannot be loaded.
boost::dll::shared_library openedLibrary(const std::string& path);

/// Untrusted text as one line of limited length.
std::string oneLine(std::string text);

/// Throws the InputError for a plugin that violates the interface.
[[noreturn]] void failPlugin(const std::string& file, const std::string& what);

/// Redirects the output of this process and of the dynamic linker to /dev/null.
void silenceStreams();

/// Runs plugin work in a child process and returns its result; the first byte is a type code other than 'i'
/// and 'x'. Output of the plugin is discarded. Empty after a stop. Throws InputError with the file name if
/// the work throws, crashes, exceeds a limit or returns nothing.
std::string answerOf(const std::string& file, const std::function<std::string()>& work,
                     const ChildLimits& limits, const ProgressMonitor& watch);

}  // namespace talus::planner
