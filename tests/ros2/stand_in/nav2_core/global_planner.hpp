// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
// TALUS_NAV2_MAIN: as in releases of Nav2 after Kilted, without it as in Jazzy and Kilted.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <nav_msgs/msg/path.hpp>
#include <tf2_ros/buffer.h>
#ifdef TALUS_NAV2_MAIN
#include <nav2_ros_common/lifecycle_node.hpp>
#else
#include <nav2_util/lifecycle_node.hpp>
#endif

namespace nav2_costmap_2d {
struct Costmap2DROS {
  std::string getGlobalFrameID() { return "map"; }
};
}  // namespace nav2_costmap_2d

namespace nav2_core {
class GlobalPlanner {
 public:
#ifdef TALUS_NAV2_MAIN
  using Node = nav2::LifecycleNode;
#else
  using Node = rclcpp_lifecycle::LifecycleNode;
#endif
  virtual ~GlobalPlanner() {}
  virtual void configure(const Node::WeakPtr& parent, std::string name, std::shared_ptr<tf2_ros::Buffer> tf,
                         std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap_ros) = 0;
  virtual void cleanup() = 0;
  virtual void activate() = 0;
  virtual void deactivate() = 0;
  virtual nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                         const geometry_msgs::msg::PoseStamped& goal,
#ifdef TALUS_NAV2_MAIN
                                         const std::vector<geometry_msgs::msg::PoseStamped>& viapoints,
#endif
                                         std::function<bool()> cancel_checker) = 0;
};
}  // namespace nav2_core
