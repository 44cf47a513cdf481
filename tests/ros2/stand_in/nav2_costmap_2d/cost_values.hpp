// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

namespace nav2_costmap_2d {
static constexpr unsigned char NO_INFORMATION = 255;
static constexpr unsigned char LETHAL_OBSTACLE = 254;
static constexpr unsigned char MAX_NON_OBSTACLE = 252;
}  // namespace nav2_costmap_2d
