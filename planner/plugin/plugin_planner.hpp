#pragma once

#include <string>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Planner of an external shared library. The library is untrusted: it is loaded and plans in a child
/// process; its route is checked with violations() and priced by MotionCost. Not thread-safe.
class PluginPlanner {
 public:
  /// Upper limits of a route: number of vertices, and length in cells.
  static constexpr std::size_t kMostVertices = 100'000;
  static constexpr int kMostCells = 1'000'000;

  /// Loads the library once in a child process to read its capabilities. `planner`: one of the planners
  /// offered; empty: the default. Throws InputError with the file name as loadPlugin(), and if the library
  /// throws, crashes or has no such planner.
  explicit PluginPlanner(std::string file, std::string planner = {});

  /// "PLANNER of PLUGIN" for reports.
  const std::string& name() const noexcept { return name_; }

  /// Returns a route between the requested places that satisfies every constraint of the map, or the plugin's
  /// own status. NoneFound with place and reason if the check refuses the route. `kinematics` is passed to
  /// the plugin if it has a turning radius or forbids reversing. The check evaluates the polyline, whose
  /// points alone define the headings, and compares chords of arcs with the turning radius and the requested
  /// headings. A stop ends the check. The plugin is killed one second after the time limit. Throws InputError
  /// if the plugin throws, crashes, takes too much memory, or returns an unreadable route.
  Plan plan(const Problem& problem) const;

  /// Unchecked result of the plugin: finite points only, and at least one point if a route was found.
  Plan unchecked(const Problem& problem) const;

 private:
  std::string file_, planner_, name_;
};

}  // namespace talus::planner
