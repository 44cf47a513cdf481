#pragma once

#include <functional>
#include <vector>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// The picture of thesis Fig. 3.12: the category of every pair (T/(rW), z/r), and the lines that part them.
struct TraversabilityPlane {
  double max_torque = 1.0;         ///< T/(rW) at the right edge [-]; 0 at the left
  double max_sinkage = 1.0;        ///< z/r at the upper edge [-]; 0 at the lower
  int columns = 0;                 ///< along T/(rW)
  int rows = 0;                    ///< along z/r, from below
  std::vector<Category> category;  ///< row by row, of the cells' centres

  /// T/(rW) and z/r of a cell's centre.
  double torqueAt(int column) const { return max_torque * (column + 0.5) / columns; }
  double sinkageAt(int row) const { return max_sinkage * (row + 0.5) / rows; }
  Category at(int column, int row) const {
    return category[static_cast<std::size_t>(row * columns + column)];
  }
};

/// DP/W [-] from T/(rW) and z/r: any estimator of drawbar pull, such as thesis Eq. 3.21, T/(rW) - z/r - 0.1.
using PullFromTorqueAndSinkage =
    std::function<double(double torque_over_load_radius, double sinkage_over_radius)>;

/// Size of the picture.
struct PlaneSize {
  int columns = 200;         ///< >= 1
  int rows = 200;            ///< >= 1
  double max_torque = 1.0;   ///< > 0 [-]
  double max_sinkage = 1.0;  ///< > 0 [-]
};

/// Categorises the whole plane. The torque criterion applies where the thresholds have one.
TraversabilityPlane traversabilityPlane(const PullFromTorqueAndSinkage& pull,
                                        const CategoryThresholds& thresholds, const PlaneSize& size = {});

/// T/(rW) where DP/W reaches a threshold at z/r, by bisection in [0, max_torque]; NaN where it does not. The
/// slanted lines of the picture.
double torqueForPull(const PullFromTorqueAndSinkage& pull, double pull_threshold, double sinkage_over_radius,
                     double max_torque);

}  // namespace talus::terramech
