// Shows   one Talus map for all plugins of a process, fed by topics: heights of the ground, readings of the wheels.
// Needs   talus::planner, talus::terramech_io, rclcpp, tf2_ros.  Used by nav2_planner.cpp and nav2_layer.cpp.
#pragma once

#include <memory>
#include <mutex>
#include <thread>

#include <rclcpp/rclcpp.hpp>
#if __has_include(<tf2_ros/transform_listener.hpp>)
#include <tf2_ros/buffer.hpp>
#include <tf2_ros/transform_listener.hpp>
#else
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#endif

#include "messages.hpp"

namespace talus_ros2 {

/// Returns the value of the parameter `name` of a node. A parameter that is not declared is first declared
/// with the default value `usual`.
template <typename T, typename Node>
T parameter(Node& node, const std::string& name, const T& usual) {
  if (!node.has_parameter(name)) node.template declare_parameter<T>(name, usual);
  T value = usual;
  node.get_parameter(name, value);
  return value;
}

/// Node `talus_map` with the map of a process; README.md lists parameters and topics. Without a map file, the map
/// begins on unknown ground and moves with the elevation maps. A message that is not usable is logged, at most every
/// five seconds, and changes nothing. Public members may be called from any thread.
class MapNode {
 public:
  /// Returns the node of this process, which ends with its last owner. The first call makes it. Throws
  /// std::invalid_argument, in one line, with the name of an invalid parameter.
  static std::shared_ptr<MapNode> shared();
  ~MapNode();

  /// Returns the current version of the cost map.
  std::shared_ptr<const talus::costmap::CostGrid> published() const;
  /// Returns the frame of the map.
  const std::string& frame() const noexcept { return frame_; }
  /// Returns a pose in the frame of the map, at the newest transform. Throws tf2::TransformException if there is none.
  geometry_msgs::msg::PoseStamped inMap(geometry_msgs::msg::PoseStamped pose) const;

 private:
  MapNode();
  talus::Map unseen(talus::maps::Point middle) const;
  Eigen::Isometry3d placeOf(const std_msgs::msg::Header& header, double max_age_s) const;
  void follow(talus::maps::Point middle);
  void see(const grid_map_msgs::msg::GridMap& message);
  void learn(const sensor_msgs::msg::PointCloud2& message);
  void publish();
  template <typename Message>
  std::shared_ptr<void> hear(const std::string& parameter_name, std::size_t depth,
                             void (MapNode::*take)(const Message&));

  std::shared_ptr<rclcpp::Node> node_;
  tf2_ros::Buffer tf_;
  tf2_ros::TransformListener listener_;
  std::string frame_, layer_;
  double max_age_s_ = 0.0;
  talus::costmap::GroundModel::Parts ground_;  // of a map that begins unknown
  talus::maps::Grid grid_;                     // of a map that begins unknown; empty with a map file
  mutable std::mutex changing_;                // guards map_
  std::unique_ptr<talus::Map> map_;
  JudgedCells cells_;
  std::shared_ptr<rclcpp::Publisher<grid_map_msgs::msg::GridMap>> ground_map_;
  std::shared_ptr<void> elevation_, wheels_, clock_;
  std::jthread spinning_;  // last: its callbacks use the members above
};

}  // namespace talus_ros2
