// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <rclcpp_lifecycle/lifecycle_node.hpp>

namespace nav2 {
class LifecycleNode : public rclcpp_lifecycle::LifecycleNode {
 public:
  using WeakPtr = std::weak_ptr<LifecycleNode>;
};
}  // namespace nav2
