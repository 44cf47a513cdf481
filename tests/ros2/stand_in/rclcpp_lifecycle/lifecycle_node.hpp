// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <any>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <rclcpp/rclcpp.hpp>

namespace rclcpp_lifecycle {

class LifecycleNode {
 public:
  using WeakPtr = std::weak_ptr<LifecycleNode>;

  bool has_parameter(const std::string& name) const { return parameters.count(name) > 0; }
  template <typename T>
  auto declare_parameter(const std::string& name, const T& value) {
    parameters[name] = value;
    return value;
  }
  template <typename T>
  bool get_parameter(const std::string& name, T& value) const {
    value = std::any_cast<T>(parameters.at(name));
    return true;
  }
  rclcpp::Logger get_logger() const { return {&log}; }
  rclcpp::Clock::SharedPtr get_clock() { return std::make_shared<rclcpp::Clock>(); }
  rclcpp::Time now() const { return rclcpp::Time(7000000000, RCL_ROS_TIME); }

  // What tests set and read.
  std::map<std::string, std::any> parameters, publishers;
  std::map<std::string, std::weak_ptr<rclcpp::SubscriptionBase>> subscribers;
  mutable std::vector<std::string> log;
};

}  // namespace rclcpp_lifecycle
