#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <boost/dll/shared_library.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/site/ground_site.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Resource limits of a child process. A child process that exceeds a limit is killed.
struct ChildLimits {
  double seconds = std::numeric_limits<double>::infinity();     ///< wall time, > 0
  std::size_t bytes = std::numeric_limits<std::size_t>::max();  ///< size of the result [bytes]
  std::uint64_t memory = 0;  ///< memory in addition to that of the parent process [bytes]; 0: no limit
};

/// Result of a child process.
struct ChildAnswer {
  /// Reason why the process ended: the work returned its result, a stop was requested, the time limit was
  /// exceeded, the result was too large, or the process ended without a result.
  enum class End { Answered, Stopped, TooLate, TooMuch, Died };
  End end = End::Died;
  std::string bytes;       ///< result of the work; empty unless `end` is Answered
  int signal = 0;          ///< number of the signal that ended the process; 0: no signal
  int exit_code = 0;       ///< exit code, if no signal ended the process
  double megabytes = 0.0;  ///< peak memory of the process [MB]
};

/// Runs `work` in a child process and returns its result. Crashes, aborts and endless loops of the work are
/// reported in ChildAnswer::end. The child process is killed if the parent process is killed. Output of the
/// child process is redirected to standard error. The function must be called while the program has no other
/// threads. An exception of the work gives the result Died. Throws std::runtime_error if no process can be
/// created.
ChildAnswer inChild(const std::function<std::string()>& work, const ChildLimits& limits,
                    const ProgressMonitor& watch = {});

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

/// Planner from a shared library outside Talus. The library is not trusted: it is loaded and plans in a child
/// process. Its route is checked with violations(), and its cost is computed by MotionCost. Not thread-safe.
class PluginPlanner {
 public:
  /// Upper limits of a route: number of vertices, and length in cell widths.
  static constexpr std::size_t kMostVertices = 100'000;
  static constexpr int kMostCells = 1'000'000;

  /// Loads the library `file` once in a child process to read its capabilities. `planner` is the name of one
  /// of its planners; empty: its default planner. Throws InputError with the file name under the conditions
  /// of loadPlugin(), and if the library throws, crashes or has no such planner.
  explicit PluginPlanner(std::string file, std::string planner = {});

  /// Returns "PLANNER of PLUGIN", the name for reports.
  const std::string& name() const noexcept { return name_; }

  /// Returns a route from start to goal that satisfies every constraint of the map, or the status of the
  /// plugin if it found no route. If the check rejects the route, the status is NoneFound and the reason
  /// contains the place and the violation. `problem.kinematics` is passed to the plugin if it has a turning
  /// radius or forbids reversing. The check evaluates the polyline: headings are those of its legs, and
  /// chords of arcs are compared with the turning radius and the requested headings. A stop request ends the
  /// check. The plugin is killed one second after the time limit. Throws InputError if the plugin throws,
  /// crashes, uses too much memory, or returns an unreadable route.
  Plan plan(const Problem& problem) const;

  /// Returns the route of the plugin without the check; all points are finite, and there is at least one
  /// point if a route was found.
  Plan unchecked(const Problem& problem) const;

 private:
  std::string file_, planner_, name_;
};

/// Loads a cost layer (additional cost per metre of each cell) from a shared library with a CostSource
/// (plugin_export.hpp), and evaluates the layer on `grid`. `file` is the path of the library, `name` the name
/// of the layer. The library is not trusted: it runs in a child process with limits of one minute and 4 GB.
/// If unknown ground is permitted, a cell with an unknown value costs as much as the most expensive cell of
/// the grid. Throws InputError with the file name if the library is not a layer plugin, was built for another
/// interface version, throws, crashes, or returns a wrong number of cells or an invalid value.
costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid);

}  // namespace talus::planner
