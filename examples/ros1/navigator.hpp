#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Interface of Talus for a ROS 1 node, in C++17. Talus requires C++20, with which the headers of ROS 1 do
/// not compile.
namespace rover_ros {

/// Position in the map frame.
struct Place {
  double x_m = 0.0, y_m = 0.0;
};
/// Position and heading in the map frame; the heading is counter-clockwise from x.
struct Pose {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};
/// Point of a point cloud in the map frame.
struct CloudPoint {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
};

/// Settings of the map and of the planner.
struct Settings {
  std::string rover = "mer";      ///< name of a rover in Talus' library, or path of a YAML file
  std::string soil = "dry_sand";  ///< name of a soil in Talus' library, or path of a YAML file
  int width = 400, height = 400;  ///< numbers of columns and rows of the map
  double resolution_m = 0.5;      ///< side length of a cell
  Place south_west{};             ///< south-western corner of the map
  /// true: routes may cross unobserved ground, which counts as level ground of the soil.
  bool allow_unknown = false;
  /// Height of a cell: this percentile, [0, 1], of the heights of its points; 1: the highest.
  /// Percentile, (0, 1], of the point heights of a cell that is its height; 1: maximum.
  double percentile = 1.0;
  int least_points = 1;  ///< least number of points of a cell; a cell with fewer points stays unobserved
  std::string planner = "field";  ///< name of the planner: "field", "hybrid", ...
  double time_limit_s = 5.0;      ///< time limit of a plan
  double tolerance_m = 0.5;       ///< permitted distance of the end of the route from the goal
  double path_spacing_m = 0.5;    ///< largest distance between consecutive poses of a path
  double pose_std_m = 0.5;        ///< standard deviation of the wheel positions
  /// Folder in which heights, telemetry evidence and goal are stored; empty: not stored.
  std::string state_folder;
};

/// Result of a plan.
struct Outcome {
  bool found = false;      ///< true if a route was found
  bool cancelled = false;  ///< true if cancel() ended the plan
  std::string status;      ///< status of the plan: "found", "no_route", "goal_invalid", ...
  std::string reason;      ///< one line with the reason if no route was found; else empty
  std::vector<Pose> path;  ///< poses from start to goal, at most Settings::path_spacing_m apart
  /// Length, energy and immobilisation probability of the route.
  double length_m = 0.0, energy_J = 0.0, risk = 0.0;
};

/// Wheel telemetry at one time, in table form: column names of a telemetry file, and the values row by row.
struct Wheels {
  std::vector<std::string> columns;
  std::vector<double> values;
};

/// Map that is extended by height observations and wheel telemetry, and a planner on this map. With a state
/// folder, a new process continues from the state of a process that was killed: telemetry evidence is on disk
/// before learn() returns, heights are on disk after save(). plan() may run in a second thread; cancel(),
/// version(), goal() and setGoal() may be called from any thread. After a failure the functions throw a
/// std::exception with a text of one line, and the map is unchanged.
class Navigator {
 public:
  explicit Navigator(const Settings& settings);
  ~Navigator();
  Navigator(const Navigator&) = delete;
  Navigator& operator=(const Navigator&) = delete;

  /// Adds heights to the map from points in the map frame. Returns the number of points that lie on the map;
  /// throws if no point lies on the map.
  std::size_t see(const std::vector<CloudPoint>& points);
  /// Adds wheel telemetry to the map. Returns the number of rows that the map used.
  std::size_t learn(const Wheels& wheels);
  /// Writes the heights to the state folder if they changed since the last call.
  void save();

  /// Sets the goal and stores it in the state folder, or removes the goal if the argument is empty.
  void setGoal(const std::optional<Place>& goal);
  /// Returns the goal; empty if no goal is set.
  std::optional<Place> goal() const;

  /// Plans a route from start to goal.
  Outcome plan(const Place& start, const Place& goal);
  /// Cancels the plan that is running, if any.
  void cancel();

  /// Returns the version of the map, which increases with every change of the map.
  unsigned long version() const;
  /// Returns one value per cell, row by row from the south-west corner: 0 safe, 50 marginal, 100 dangerous or
  /// excluded for all headings, -1 not observed, even if Settings::allow_unknown permits routes there. Must
  /// be called in the thread that calls see() and learn().
  std::vector<signed char> occupancy() const;
  /// Returns a text for the log that describes the state read from the state folder; empty if no state was
  /// read.
  const std::string& restored() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the name in `known` that is most similar to `word`, or an empty text if no name is similar.
std::string nearestName(const std::string& word, const std::vector<std::string>& known);

}  // namespace rover_ros
