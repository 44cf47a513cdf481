// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <std_msgs/msg/float32_multi_array.hpp>

namespace grid_map_msgs::msg {
struct GridMapInfo {
  double resolution = 0.0, length_x = 0.0, length_y = 0.0;
  geometry_msgs::msg::Pose pose;
};
struct GridMap {
  std_msgs::msg::Header header;
  GridMapInfo info;
  std::vector<std::string> layers, basic_layers;
  std::vector<std_msgs::msg::Float32MultiArray> data;
  std::uint16_t outer_start_index = 0, inner_start_index = 0;
};
}  // namespace grid_map_msgs::msg
