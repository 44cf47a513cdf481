// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
// As in releases of Nav2 after Kilted: create_subscription() and create_publisher() hide those of rclcpp and take other orders.
#pragma once

#include <rclcpp_lifecycle/lifecycle_node.hpp>

namespace nav2 {
class LifecycleNode : public rclcpp_lifecycle::LifecycleNode {
 public:
  using WeakPtr = std::weak_ptr<LifecycleNode>;

  template <typename Message, typename Callback>
  std::shared_ptr<rclcpp::Subscription<Message>> create_subscription(
      const std::string& topic_name, Callback&& callback, const rclcpp::QoS& qos = rclcpp::QoS(10),
      const rclcpp::CallbackGroup::SharedPtr& callback_group = nullptr) {
    rclcpp::SubscriptionOptions options;
    options.callback_group = callback_group;
    return rclcpp::create_subscription<Message>(*this, topic_name, qos, std::forward<Callback>(callback),
                                                options);
  }
};
}  // namespace nav2
