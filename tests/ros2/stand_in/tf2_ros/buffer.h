// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

namespace tf2_ros {
class Buffer {};
}  // namespace tf2_ros
