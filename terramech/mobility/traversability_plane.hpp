#pragma once

#include <functional>
#include <vector>

#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// Raster of traversability categories over the torque ratio T/(rW) and the sinkage over radius z/r of a
/// wheel (thesis Fig. 3.12).
struct TraversabilityPlane {
  double max_torque = 1.0;         ///< T/(rW) at the right edge [-]; the left edge is 0
  double max_sinkage = 1.0;        ///< z/r at the upper edge [-]; the lower edge is 0
  int columns = 0;                 ///< number of columns, along T/(rW)
  int rows = 0;                    ///< number of rows, along z/r from the lower edge
  std::vector<Category> category;  ///< category at the centre of each cell, row by row

  /// Return T/(rW) of a column centre, z/r of a row centre, and the category of a cell.
  double torqueAt(int column) const { return max_torque * (column + 0.5) / columns; }
  double sinkageAt(int row) const { return max_sinkage * (row + 0.5) / rows; }
  Category at(int column, int row) const {
    return category[static_cast<std::size_t>(row * columns + column)];
  }
};

/// Function that returns drawbar pull over load DP/W [-] from T/(rW) and z/r. Any estimator of drawbar pull
/// may be used, for example thesis Eq. 3.21, DP/W = T/(rW) - z/r - 0.1.
using PullFromTorqueAndSinkage =
    std::function<double(double torque_over_load_radius, double sinkage_over_radius)>;

/// Number of cells and extent of a TraversabilityPlane.
struct PlaneSize {
  int columns = 200;         ///< number of columns, in [1, 1e4]
  int rows = 200;            ///< number of rows, in [1, 1e4]
  double max_torque = 1.0;   ///< greatest T/(rW), > 0 [-]
  double max_sinkage = 1.0;  ///< greatest z/r, > 0 [-]
};

/// Returns the raster with the traversability category of every cell. The torque criterion is applied if
/// `thresholds` contains a torque limit. Throws std::invalid_argument if the thresholds or the size are
/// outside their range.
TraversabilityPlane traversabilityPlane(const PullFromTorqueAndSinkage& pull,
                                        const CategoryThresholds& thresholds, const PlaneSize& size = {});

/// Returns the torque ratio T/(rW) at which DP/W equals pull_threshold at the given z/r, by bisection in [0,
/// max_torque]. Returns NaN if DP/W does not cross the threshold there. The function gives the slanted lines
/// of thesis Fig. 3.12.
double torqueForPull(const PullFromTorqueAndSinkage& pull, double pull_threshold, double sinkage_over_radius,
                     double max_torque);

}  // namespace talus::terramech
