// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <memory>

#include <rclcpp/rclcpp.hpp>

namespace rclcpp_lifecycle {
class LifecycleNode : public rclcpp::AnyNode {
 public:
  using WeakPtr = std::weak_ptr<LifecycleNode>;
};
}  // namespace rclcpp_lifecycle
