#pragma once

#include <string>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

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

}  // namespace talus::planner
