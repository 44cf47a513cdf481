// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <tf2_ros/buffer.h>

namespace tf2_ros {
class TransformListener {
 public:
  explicit TransformListener(Buffer&) {}
};
}  // namespace tf2_ros
