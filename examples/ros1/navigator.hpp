#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Interface of Talus for a ROS 1 node, in C++17: headers of ROS 1 do not compile as C++20, which Talus
/// requires.
namespace rover_ros {

/// Place, or place and heading, in the map frame.
struct Place {
  double x_m = 0.0, y_m = 0.0;
};
struct Pose {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};
struct CloudPoint {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
};

/// Settings of the map and of the planner.
struct Settings {
  std::string rover = "mer";      ///< name in Talus' library, or YAML file
  std::string soil = "dry_sand";  ///< name in Talus' library, or YAML file
  int width = 400, height = 400;  ///< size of the map in cells
  double resolution_m = 0.5;      ///< side of a cell
  Place south_west{};             ///< outer corner of the map
  bool allow_unknown = false;     ///< true: unobserved ground is planned as level ground of the soil
  double percentile = 1.0;        ///< percentile of the points of a cell by height; 1: the highest
  int least_points = 1;           ///< cells with fewer points stay unobserved
  std::string planner = "field";  ///< "field", "hybrid", ...
  double time_limit_s = 5.0;      ///< limit per plan
  double tolerance_m = 0.5;       ///< allowed distance of the route's end from the goal
  double path_spacing_m = 0.5;    ///< largest distance between poses of a path
  double pose_std_m = 0.5;        ///< standard deviation of the wheel positions
  std::string state_folder;       ///< folder for heights, evidence and goal; empty: not stored
};

/// Result of a plan.
struct Outcome {
  bool found = false;
  bool cancelled = false;
  std::string status;      ///< "found", "no_route", "goal_invalid", ...
  std::string reason;      ///< one line; empty when found
  std::vector<Pose> path;  ///< from start to goal, at most Settings::path_spacing_m apart
  double length_m = 0.0, energy_J = 0.0, risk = 0.0;
};

/// Wheel telemetry of one moment: columns as in a file, values row by row.
struct Wheels {
  std::vector<std::string> columns;
  std::vector<double> values;
};

/// Map that grows with observations and telemetry, and a planner on the map. With a state folder a new
/// process continues the state of a killed one: evidence is on disk before learn() returns, heights after
/// save(). plan() may run in a second thread; cancel(), version(), goal() and setGoal() may be called from
/// any thread. A failure throws a std::exception with one line and leaves the map unchanged.
class Navigator {
 public:
  explicit Navigator(const Settings& settings);
  ~Navigator();
  Navigator(const Navigator&) = delete;
  Navigator& operator=(const Navigator&) = delete;

  /// Adds heights from points in the map frame. Returns the number of points on the map; throws if there is
  /// none.
  std::size_t see(const std::vector<CloudPoint>& points);
  /// Adds wheel telemetry. Returns the number of rows used.
  std::size_t learn(const Wheels& wheels);
  /// Writes the heights if they changed since the last call.
  void save();

  /// Sets the goal, which is stored in the state folder, or removes it.
  void setGoal(const std::optional<Place>& goal);
  std::optional<Place> goal() const;

  Outcome plan(const Place& start, const Place& goal);
  /// Cancels the running plan, if any.
  void cancel();

  /// Returns the map version, which increases with every change.
  unsigned long version() const;
  /// Returns one value per cell, row by row from the south-west: 0 safe, 50 marginal, 100 dangerous or
  /// refused, -1 not observed, even if Settings::allow_unknown permits routes there. Call from the thread of
  /// see() and learn().
  std::vector<signed char> occupancy() const;
  /// Returns a text for the log on the state read from the state folder; empty if none.
  const std::string& restored() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the known name most similar to a mistyped one, or an empty text.
std::string nearestName(const std::string& word, const std::vector<std::string>& known);

}  // namespace rover_ros
