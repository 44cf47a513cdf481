// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
// As in Jazzy and Kilted.
#pragma once

#include <rclcpp_lifecycle/lifecycle_node.hpp>

namespace nav2_util {
class LifecycleNode : public rclcpp_lifecycle::LifecycleNode {};
}  // namespace nav2_util
