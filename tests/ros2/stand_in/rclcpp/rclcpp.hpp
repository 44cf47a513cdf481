// A stand-in of our own for tests: the names that examples/ros2 uses, and nothing else.
#pragma once

#include <any>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>

namespace rclcpp {
struct Logger {
  std::vector<std::string>* lines;
};
}  // namespace rclcpp

#define RCLCPP_WARN(logger, format, text) (logger).lines->push_back(text)

namespace rclcpp_lifecycle {

class LifecycleNode {
 public:
  using WeakPtr = std::weak_ptr<LifecycleNode>;

  bool has_parameter(const std::string& name) const { return parameters.count(name) > 0; }
  template <typename T>
  T declare_parameter(const std::string& name, const T& value) {
    parameters[name] = value;
    return value;
  }
  template <typename T>
  bool get_parameter(const std::string& name, T& value) const {
    value = std::any_cast<T>(parameters.at(name));
    return true;
  }
  template <typename Message>
  std::shared_ptr<std::any> create_subscription(const std::string& topic, int,
                                                std::function<void(const Message&)> callback) {
    subscribers[topic] = callback;
    return std::make_shared<std::any>();
  }
  rclcpp::Logger get_logger() { return {&log}; }
  builtin_interfaces::msg::Time now() const { return {7}; }

  std::map<std::string, std::any> parameters, subscribers;
  std::vector<std::string> log;
};

}  // namespace rclcpp_lifecycle
