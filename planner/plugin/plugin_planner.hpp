#pragma once

#include <string>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// A planner of somebody else's shared library, trusted in nothing: it is loaded and plans in a child process, and
/// its route is held against violations() and priced by MotionCost before anybody sees it. Not thread-safe.
class PluginPlanner {
 public:
  /// Vertices of a route, and its length in cells.
  static constexpr std::size_t kMostVertices = 100'000;
  static constexpr int kMostCells = 1'000'000;

  /// Loads it once, in a child, to ask what it is. `planner`: one of those that it offers; empty: its default. Throws
  /// InputError naming the file, as loadPlugin() does, and where it throws, crashes or has no such planner.
  explicit PluginPlanner(std::string file, std::string planner = {});

  /// "PLANNER of PLUGIN", for reports.
  const std::string& name() const noexcept { return name_; }

  /// A route that keeps every constraint of the map between the places asked for; NoneFound with place and reason where
  /// the check refuses it, or the plugin's own answer. `kinematics` is asked for where it has a turning radius or
  /// forbids reversing; the check judges the polyline, whose places alone give its headings, with the chords of arcs held against
  /// the turning radius and the headings requested. A stop ends the check. A time limit is enforced: a second beyond it the plugin is
  /// ended. Throws InputError when it throws, crashes, takes too much memory, or returns no route that can be read.
  Plan plan(const Problem& problem) const;

  /// What the plugin answers, as it is: points alone, finite, at least one where it found a route.
  Plan unchecked(const Problem& problem) const;

 private:
  std::string file_, planner_, name_;
};

}  // namespace talus::planner
