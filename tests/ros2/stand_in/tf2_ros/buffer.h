// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <rclcpp/rclcpp.hpp>

namespace tf2_ros {
class Buffer {
 public:
  explicit Buffer(rclcpp::Clock::SharedPtr) {}
  geometry_msgs::msg::TransformStamped lookupTransform(
      const std::string& /*target_frame*/, const std::string& source_frame, const rclcpp::Time&,
      const rclcpp::Duration = rclcpp::Duration::from_nanoseconds(0)) const {
    if (!known.contains(source_frame))
      throw std::runtime_error("frame '" + source_frame + "' does not exist");
    return known.at(source_frame);
  }

  inline static std::map<std::string, geometry_msgs::msg::TransformStamped>
      known;  // what tests set, by source
};
}  // namespace tf2_ros
