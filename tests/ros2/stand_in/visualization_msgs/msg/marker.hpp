// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <std_msgs/msg/color_rgba.hpp>

namespace visualization_msgs::msg {
struct Marker {
  static constexpr std::int32_t LINE_STRIP = 4, ADD = 0;
  std_msgs::msg::Header header;
  std::string ns;
  std::int32_t id = 0, type = 0, action = 0;
  geometry_msgs::msg::Pose pose;
  geometry_msgs::msg::Vector3 scale;
  std::vector<geometry_msgs::msg::Point> points;
  std::vector<std_msgs::msg::ColorRGBA> colors;
};
}  // namespace visualization_msgs::msg
