// A stand-in of our own for tests: the names that examples/ros2 uses, declared as declarations_test.cpp lists them.
// A ring of cells as in grid_map: index (0, 0) after unwrapping has the greatest x and y.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace grid_map {

using Matrix = Eigen::MatrixXf;
using Index = Eigen::Array2i;
using Size = Eigen::Array2i;
using Length = Eigen::Array2d;
using Position = Eigen::Vector2d;

class GridMap {
 public:
  explicit GridMap(const std::vector<std::string>& layers = {}) {
    for (const std::string& layer : layers) layers_[layer];
  }
  void setFrameId(const std::string& frame) { frame_ = frame; }
  const std::string& getFrameId() const { return frame_; }
  void setGeometry(const Length& length, double resolution, const Position& position) {
    size_ = (length / resolution).round().cast<int>();
    resolution_ = resolution;
    position_ = position;
    for (auto& [name, data] : layers_) data = Matrix::Constant(size_(0), size_(1), NAN);
  }
  void setStartIndex(const Index& start) { start_ = start; }
  const Index& getStartIndex() const { return start_; }
  const Size& getSize() const { return size_; }
  double getResolution() const { return resolution_; }
  const Position& getPosition() const { return position_; }
  bool exists(const std::string& layer) const { return layers_.count(layer) > 0; }
  const Matrix& get(const std::string& layer) const { return layers_.at(layer); }
  Matrix& get(const std::string& layer) { return layers_.at(layer); }

 private:
  std::map<std::string, Matrix> layers_;
  std::string frame_;
  Size size_{0, 0};
  Index start_{0, 0};
  double resolution_ = 0.0;
  Position position_{0.0, 0.0};
};

}  // namespace grid_map
