// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

namespace std_msgs::msg {
struct ColorRGBA {
  float r = 0.0F, g = 0.0F, b = 0.0F, a = 0.0F;
};
}  // namespace std_msgs::msg
