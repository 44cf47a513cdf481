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

/// Memory that a child that runs a plugin may take beyond the program's own, bytes.
inline constexpr std::uint64_t kMostPluginMemory = std::uint64_t{4} << 30;

/// What planner and layer plugins share: how they are loaded (plugin_loader.cpp) and asked (plugin_planner.cpp).

/// A shared library that was loaded by a child process first, which tells by a signal what loading it would do to this one.
/// Throws InputError naming the file when it is missing, is no library, or ends the process that loads it.
boost::dll::shared_library openedLibrary(const std::string& path);

/// A text of somebody else's as one line that is not long.
std::string oneLine(std::string text);

/// Throws the InputError of a plugin that does what it must not.
[[noreturn]] void failPlugin(const std::string& file, const std::string& what);

/// Leads what this process prints, and the dynamic linker for it, nowhere.
void silenceStreams();

/// What work with a plugin returns, done in a child process; its first byte says what it is, neither 'i' nor 'x'. What the plugin prints
/// is lost. Empty where a stop was requested. Throws InputError naming the file when the work throws, crashes, passes a limit or answers
/// nothing.
std::string answerOf(const std::string& file, const std::function<std::string()>& work,
                     const ChildLimits& limits, const ProgressMonitor& watch);

}  // namespace talus::planner
