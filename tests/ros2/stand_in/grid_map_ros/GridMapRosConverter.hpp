// A stand-in of our own for tests: the names that examples/ros2 uses, and nothing else.
#pragma once

#include <grid_map_msgs/msg/grid_map.hpp>

namespace grid_map {
struct GridMapRosConverter {
  static bool fromMessage(const grid_map_msgs::msg::GridMap& message, GridMap& map) {
    map = message.map;
    return true;
  }
};
}  // namespace grid_map
