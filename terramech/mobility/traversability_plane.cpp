#include <cmath>
#include <limits>

#include <talus/terramech/mobility/traversability_plane.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {

TraversabilityPlane traversabilityPlane(const PullFromTorqueAndSinkage& pull,
                                        const CategoryThresholds& thresholds, const PlaneSize& size) {
  validate(thresholds);
  const RangeCheck check{"traversability plane"};
  check.within("columns", size.columns, {1.0, 1e4});
  check.within("rows", size.rows, {1.0, 1e4});
  check.above("max_torque", size.max_torque, 0.0);
  check.above("max_sinkage", size.max_sinkage, 0.0);
  TraversabilityPlane plane{size.max_torque, size.max_sinkage, size.columns, size.rows, {}};
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const double torque = plane.torqueAt(column), sinkage = plane.sinkageAt(row);
      plane.category.push_back(categorise({.drawbar_pull_over_load = pull(torque, sinkage),
                                           .sinkage_over_radius = sinkage,
                                           .torque_over_load_radius = torque},
                                          thresholds));
    }
  return plane;
}

double torqueForPull(const PullFromTorqueAndSinkage& pull, double pull_threshold, double sinkage_over_radius,
                     double max_torque) {
  double low = 0.0, high = max_torque;
  const auto reaches = [&](double torque) { return pull(torque, sinkage_over_radius) >= pull_threshold; };
  if (reaches(low) || !reaches(high)) return std::numeric_limits<double>::quiet_NaN();
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (reaches(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace talus::terramech
