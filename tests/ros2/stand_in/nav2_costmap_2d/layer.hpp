// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
// TALUS_NAV2_MAIN: as in releases of Nav2 after Kilted, without it as in Jazzy and Kilted.
#pragma once

#include <atomic>
#include <string>

#include <nav2_costmap_2d/costmap_2d.hpp>
#include <nav2_costmap_2d/layered_costmap.hpp>
#include <tf2_ros/buffer.h>
#ifdef TALUS_NAV2_MAIN
#include <nav2_ros_common/lifecycle_node.hpp>
#else
#include <nav2_util/lifecycle_node.hpp>
#endif

namespace nav2_costmap_2d {
class Layer {
 public:
#ifdef TALUS_NAV2_MAIN
  using Node = nav2::LifecycleNode;
  using KeptNode = nav2::LifecycleNode;
#else
  using Node = nav2_util::LifecycleNode;
  using KeptNode = rclcpp_lifecycle::LifecycleNode;
#endif
  virtual ~Layer() {}
  void initialize(LayeredCostmap* parent, std::string name, tf2_ros::Buffer*, const Node::WeakPtr& node,
                  rclcpp::CallbackGroup::SharedPtr callback_group) {
    layered_costmap_ = parent;
    name_ = name;
    node_ = node;
    callback_group_ = callback_group;
    onInitialize();
  }
  virtual void deactivate() {}
  virtual void activate() {}
  virtual void reset() = 0;
  virtual bool isClearable() = 0;
  virtual void updateBounds(double robot_x, double robot_y, double robot_yaw, double* min_x, double* min_y,
                            double* max_x, double* max_y) = 0;
  virtual void updateCosts(Costmap2D& master_grid, int min_i, int min_j, int max_i, int max_j) = 0;
  virtual void matchSize() {}
  bool isCurrent() const {
    return current_;
  }

 protected:
  virtual void onInitialize() {}

  LayeredCostmap* layered_costmap_ = nullptr;
  std::string name_;
  rclcpp::CallbackGroup::SharedPtr callback_group_;
  KeptNode::WeakPtr node_;
#ifdef TALUS_NAV2_MAIN
  std::atomic_bool current_{false};
#else
  bool current_ = false;
#endif
  bool enabled_ = false;
};
}  // namespace nav2_costmap_2d
