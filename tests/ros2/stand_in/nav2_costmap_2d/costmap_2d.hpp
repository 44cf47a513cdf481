// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
#pragma once

#include <vector>

namespace nav2_costmap_2d {
class Costmap2D {
 public:
  Costmap2D(unsigned int cells_size_x, unsigned int cells_size_y, double resolution, double origin_x,
            double origin_y, unsigned char default_value = 0)
      : size_x_(cells_size_x),
        resolution_(resolution),
        origin_x_(origin_x),
        origin_y_(origin_y),
        costs_(static_cast<std::size_t>(cells_size_x) * cells_size_y, default_value) {}
  void mapToWorld(unsigned int mx, unsigned int my, double& wx, double& wy) const {
    wx = origin_x_ + (mx + 0.5) * resolution_;
    wy = origin_y_ + (my + 0.5) * resolution_;
  }
  unsigned int getIndex(unsigned int mx, unsigned int my) const { return my * size_x_ + mx; }
  unsigned char* getCharMap() const { return costs_.data(); }
  double getResolution() const { return resolution_; }

 private:
  unsigned int size_x_;
  double resolution_, origin_x_, origin_y_;
  mutable std::vector<unsigned char> costs_;
};
}  // namespace nav2_costmap_2d
