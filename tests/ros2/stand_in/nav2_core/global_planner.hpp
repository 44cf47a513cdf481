// A stand-in of our own for tests: the names that examples/ros2 uses, and nothing else. TALUS_VIAPOINTS: as in releases of
// Nav2 that have via points, without it as in Jazzy.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nav_msgs/msg/path.hpp>
#include <rclcpp/rclcpp.hpp>

namespace tf2_ros {
class Buffer {};
}  // namespace tf2_ros

namespace nav2_costmap_2d {
struct Costmap2DROS {
  std::string getGlobalFrameID() const { return "map"; }
};
}  // namespace nav2_costmap_2d

namespace nav2_core {
class GlobalPlanner {
 public:
  virtual ~GlobalPlanner() = default;
  virtual void configure(const rclcpp_lifecycle::LifecycleNode::WeakPtr& parent, std::string name,
                         std::shared_ptr<tf2_ros::Buffer> tf,
                         std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap) = 0;
  virtual void cleanup() = 0;
  virtual void activate() = 0;
  virtual void deactivate() = 0;
  virtual nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                         const geometry_msgs::msg::PoseStamped& goal,
#ifdef TALUS_VIAPOINTS
                                         const std::vector<geometry_msgs::msg::PoseStamped>& viapoints,
#endif
                                         std::function<bool()> cancel_checker) = 0;
};
}  // namespace nav2_core
