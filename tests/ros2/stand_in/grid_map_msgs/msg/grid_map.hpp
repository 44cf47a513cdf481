// A stand-in of our own for tests: the message holds the map itself.
#pragma once

#include <grid_map_core/GridMap.hpp>

namespace grid_map_msgs::msg {
struct GridMap {
  grid_map::GridMap map;
};
}  // namespace grid_map_msgs::msg
