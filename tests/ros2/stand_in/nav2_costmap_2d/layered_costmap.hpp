// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <string>

#include <nav2_costmap_2d/costmap_2d.hpp>

namespace nav2_costmap_2d {
class LayeredCostmap {
 public:
  LayeredCostmap(std::string global_frame, bool rolling_window, bool /*track_unknown*/)
      : frame_(global_frame), rolling_(rolling_window) {}
  std::string getGlobalFrameID() const { return frame_; }
  bool isRolling() { return rolling_; }

 private:
  std::string frame_;
  bool rolling_;
};
}  // namespace nav2_costmap_2d
