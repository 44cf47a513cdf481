// Shows   messages of ROS 2 as values of Talus: heights, wheel readings; and back: a map, a route.
// Needs   talus::planner and the packages of the messages.  Used by map_node.cpp and nav2_planner.cpp.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <grid_map_msgs/msg/grid_map.hpp>
#include <nav_msgs/msg/path.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>

#include <talus/planner/planner.hpp>

namespace talus_ros2 {

/// Throws std::invalid_argument if a condition does not hold.
inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

/// Returns a position and an orientation of a message as a transform; an orientation of zeros is none.
template <typename Position, typename Orientation>
Eigen::Isometry3d isometryOf(const Position& p, const Orientation& q) {
  Eigen::Quaterniond turn(q.w, q.x, q.y, q.z);
  if (turn.norm() < 1e-6) turn.setIdentity();
  return Eigen::Translation3d(p.x, p.y, p.z) * turn.normalized();
}

/// Heights of a grid map.
struct Heights {
  /// Height [m] by column along x and row along y, on a grid of cells of size 1 with the centre of cell (0, 0) at
  /// (0, 0); NaN: not seen.
  talus::maps::Raster<float> z_m;
  double resolution_m = 0.0;
  /// Transform from places [m] relative to the centre of cell (0, 0) to the frame of the message.
  Eigen::Isometry3d T_frame_cells;
};

/// Returns a layer of a grid map as heights. Throws std::invalid_argument, in one line, for a message that is empty,
/// lacks the layer or has inconsistent sizes.
Heights heightsOf(const grid_map_msgs::msg::GridMap& message, const std::string& layer);

/// Returns heights as a patch of a map, of the part within the map; nullopt if there is none. A cell of the map has the
/// highest of the heights in it. Between the centres of the message's cells heights are interpolated, except across a
/// rise that is too steep for any heading, which remains a step. Throws std::invalid_argument if the message is tilted
/// by more than 20 degrees against the map.
std::optional<talus::costmap::SurfacePatch> patchOf(const Heights& seen, const Eigen::Isometry3d& T_map_frame,
                                                    const talus::costmap::TraversabilityMap& map);

/// Returns the wheel readings of a point cloud: one point for each wheel and time, one field (FLOAT32 or FLOAT64) for
/// each column of a telemetry file. x_m, y_m, z_m and heading_rad are transformed to the frame of the map. Without the
/// field time_s the time is the stamp, and without wheel the wheels are counted. Throws std::invalid_argument, in one
/// line, for a message of inconsistent sizes.
talus::Telemetry wheelsOf(const sensor_msgs::msg::PointCloud2& message, const Eigen::Isometry3d& T_map_frame);

/// Cells of a cost map as a planner without headings takes them. Computed judgements are kept.
class JudgedCells {
 public:
  using Version = std::shared_ptr<const talus::costmap::CostGrid>;

  /// Changes to a version, not null, of the map. Returns boxes that contain all cells that differ from the version before.
  std::vector<talus::maps::CellBox> show(Version version);
  /// Returns the judgement of a cell of the version.
  talus::planner::CellJudgement at(talus::maps::Cell cell);
  /// Returns the cost of a cell relative to the cheapest level ground, [1, infinity]; infinite unless every heading is
  /// allowed.
  double costRatio(const talus::planner::CellJudgement& judgement) const {
    return static_cast<double>(judgement.highest_J_per_m / judge_->level_J_per_m());
  }
  const Version& version() const { return version_; }

 private:
  struct Judged {
    talus::costmap::CellCode code;
    talus::planner::CellJudgement judgement;
  };
  Version version_;
  std::optional<talus::planner::CellJudge> judge_;
  std::vector<Judged> cells_;
};

/// Returns a map as a grid map with the layers `elevation` [m], `category` (0 safe, 1 marginal, 2 dangerous; NaN:
/// unknown), `cost` [J/m] of the most expensive heading (infinite if a heading is refused, NaN: unknown), and
/// `drawbar_pull`, the mean of drawbar pull over load. `cells` are those of the newest version of the map.
grid_map_msgs::msg::GridMap gridMapOf(const talus::costmap::TraversabilityMap& map, JudgedCells& cells,
                                      const std_msgs::msg::Header& header);

/// Returns the route as a path with a pose at each vertex, and further poses, so that poses are at most
/// `spacing_m` > 0 apart. z is the elevation of the ground; on unobserved ground z is that of the previous
/// pose.
nav_msgs::msg::Path pathOf(const talus::planner::Route& route, const std_msgs::msg::Header& header,
                           double spacing_m);

}  // namespace talus_ros2
