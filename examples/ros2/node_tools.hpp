// Shows   parameters and subscriptions on any node class of ROS 2; nav2::LifecycleNode hides rclcpp members.
// Needs   rclcpp.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>

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

/// Subscribes to a topic with a queue of one message, for publishers of any reliability. `callback` is called
/// with each message, in the callback group `group`; null: the default group of the node.
template <typename Message, typename Node, typename Callback>
std::shared_ptr<void> newestOf(const std::shared_ptr<Node>& node, const std::string& topic, Callback callback,
                               const rclcpp::CallbackGroup::SharedPtr& group = nullptr) {
  rclcpp::SubscriptionOptions options;
  options.callback_group = group;
  return rclcpp::create_subscription<Message>(*node, topic, rclcpp::QoS(1).best_effort(), std::move(callback),
                                              options);
}

}  // namespace talus_ros2
