#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What a ROS node needs of Talus, in C++17: the headers of ROS 1 do not compile as C++20, which those of Talus are.
namespace rover_ros {

/// A place, or a place and a heading, in the map's frame.
struct Place {
  double x_m = 0.0, y_m = 0.0;
};
struct Pose {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};
struct CloudPoint {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
};

/// The map and how to plan on it.
struct Settings {
  std::string rover = "mer";      ///< of Talus' library, or a YAML file
  std::string soil = "dry_sand";  ///< likewise
  int width = 400, height = 400;  ///< cells
  double resolution_m = 0.5;      ///< side of a cell
  Place south_west{};             ///< outer corner of the map
  bool allow_unknown = false;     ///< unobserved ground counts as level ground of the soil
  double percentile = 1.0;        ///< of the points of a cell by height; 1: the highest
  int least_points = 1;           ///< fewer leave a cell unobserved
  std::string planner = "field";  ///< "field", "hybrid", ...
  double time_limit_s = 5.0;      ///< of a plan
  double tolerance_m = 0.5;       ///< a route may end so far from the goal
  double path_spacing_m = 0.5;    ///< between the poses of a path
  double pose_std_m = 0.5;        ///< how well the wheels' places are known
  std::string state_folder;       ///< where heights, evidence and goal are kept; empty: nowhere
};

/// How a plan ended.
struct Outcome {
  bool found = false;
  bool cancelled = false;
  std::string status;      ///< "found", "no_route", "goal_invalid", ...
  std::string reason;      ///< one line; empty when found
  std::vector<Pose> path;  ///< from start to goal, Settings::path_spacing_m apart or less
  double length_m = 0.0, energy_J = 0.0, risk = 0.0;
};

/// A table of wheel telemetry of one moment: columns as in a file, row by row.
struct Wheels {
  std::vector<std::string> columns;
  std::vector<double> values;
};

/// A map that grows as the rover sees and drives, and a planner on it. With a state folder it goes on where a process that
/// was killed ended: evidence is on the disk before learn() returns, heights after save(). plan() may run in a second
/// thread; cancel(), version(), goal() and setGoal() may be called from any. What fails is a std::exception of one line,
/// and the map stays as it was.
class Navigator {
 public:
  explicit Navigator(const Settings& settings);
  ~Navigator();
  Navigator(const Navigator&) = delete;
  Navigator& operator=(const Navigator&) = delete;

  /// Heights from points in the map's frame. Points off the map are left out; how many were on it.
  std::size_t see(const std::vector<CloudPoint>& points);
  /// Wheel telemetry; how many rows taught something.
  std::size_t learn(const Wheels& wheels);
  /// Writes the heights, if they changed since.
  void save();

  /// The goal outlives the process.
  void setGoal(const std::optional<Place>& goal);
  std::optional<Place> goal() const;

  Outcome plan(const Place& start, const Place& goal);
  /// Ends the plan that runs, if one does.
  void cancel();

  /// Grows with every change of the map.
  unsigned long version() const;
  /// A value a cell, from the south-west, row by row: 0 safe, 50 marginal, 100 dangerous or refused, -1 not observed, also
  /// where Settings::allow_unknown lets routes go. From the thread that sees and learns.
  std::vector<signed char> occupancy() const;
  /// What was read back from the state folder, for the log; empty: nothing.
  const std::string& restored() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The known name next to a mistyped one, or empty.
std::string nearestName(const std::string& word, const std::vector<std::string>& known);

}  // namespace rover_ros
