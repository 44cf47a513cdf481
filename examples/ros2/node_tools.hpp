// Shows   parameters and subscriptions on any node class of ROS 2: nav2::LifecycleNode hides members of rclcpp.
// Needs   rclcpp.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

namespace talus_ros2 {

/// Returns a parameter, after declaring it if necessary.
template <typename T, typename Node>
T parameter(Node& node, const std::string& name, const T& usual) {
  if (!node.has_parameter(name)) node.template declare_parameter<T>(name, usual);
  T value = usual;
  node.get_parameter(name, value);
  return value;
}

/// Subscribes to the newest message of a topic, with any reliability of its publisher. Without a group the
/// node's default group is used.
template <typename Message, typename Node, typename Callback>
std::shared_ptr<void> newestOf(const std::shared_ptr<Node>& node, const std::string& topic, Callback callback,
                               const rclcpp::CallbackGroup::SharedPtr& group = nullptr) {
  rclcpp::SubscriptionOptions options;
  options.callback_group = group;
  return rclcpp::create_subscription<Message>(*node, topic, rclcpp::QoS(1).best_effort(), std::move(callback),
                                              options);
}

}  // namespace talus_ros2
