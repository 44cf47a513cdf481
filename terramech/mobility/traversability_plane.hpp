#pragma once

#include <functional>
#include <vector>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// Raster of categories over torque T/(rW) and sinkage z/r, as thesis Fig. 3.12.
struct TraversabilityPlane {
  double max_torque = 1.0;         ///< T/(rW) at the right edge [-]; the left edge is 0
  double max_sinkage = 1.0;        ///< z/r at the upper edge [-]; the lower edge is 0
  int columns = 0;                 ///< along T/(rW)
  int rows = 0;                    ///< along z/r, from the lower edge
  std::vector<Category> category;  ///< row by row, at the centres of the cells

  /// T/(rW) and z/r at the centre of a cell.
  double torqueAt(int column) const { return max_torque * (column + 0.5) / columns; }
  double sinkageAt(int row) const { return max_sinkage * (row + 0.5) / rows; }
  Category at(int column, int row) const {
    return category[static_cast<std::size_t>(row * columns + column)];
  }
};

/// Returns DP/W [-] from T/(rW) and z/r: any estimator of drawbar pull, such as thesis Eq. 3.21, T/(rW) - z/r
/// - 0.1.
using PullFromTorqueAndSinkage =
    std::function<double(double torque_over_load_radius, double sinkage_over_radius)>;

/// Size of the raster.
struct PlaneSize {
  int columns = 200;         ///< in [1, 1e4]
  int rows = 200;            ///< in [1, 1e4]
  double max_torque = 1.0;   ///< > 0 [-]
  double max_sinkage = 1.0;  ///< > 0 [-]
};

/// Returns the category of every cell. The torque criterion applies if the thresholds have one. Throws
/// std::invalid_argument if the thresholds or the size are outside their range.
TraversabilityPlane traversabilityPlane(const PullFromTorqueAndSinkage& pull,
                                        const CategoryThresholds& thresholds, const PlaneSize& size = {});

/// Returns T/(rW) at which DP/W reaches a threshold at z/r, by bisection in [0, max_torque]; NaN without a
/// crossing. These are the slanted lines of thesis Fig. 3.12.
double torqueForPull(const PullFromTorqueAndSinkage& pull, double pull_threshold, double sinkage_over_radius,
                     double max_torque);

}  // namespace talus::terramech
