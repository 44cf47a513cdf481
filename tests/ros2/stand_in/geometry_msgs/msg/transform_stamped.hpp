// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <geometry_msgs/msg/pose_stamped.hpp>

namespace geometry_msgs::msg {
struct Transform {
  Vector3 translation;
  Quaternion rotation;
};
struct TransformStamped {
  std_msgs::msg::Header header;
  Transform transform;
};
}  // namespace geometry_msgs::msg
