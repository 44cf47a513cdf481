#pragma once

#include <functional>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>
#include <talus/costmap/surface/hazards.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

namespace talus::costmap {

/// Rock size that a rover cannot cross, and the area that must be free of such rocks.
struct RockCrossing {
  double diameter_m = 0.0;  ///< diameter of the smallest rock that the rover cannot cross, > 0
  double area_m2 = 0.0;     ///< area of the rover's footprint, > 0
};

/// Returns the probability P that at least one rock of diameter >= D = crossing.diameter_m lies on the area A
/// = crossing.area_m2, where rocks cover the fraction `abundance` = k (0 to 1) of the ground. Returns 0 for
/// an abundance that is NaN or not positive.
///   F(D) = k e^(-q D),  q = 1.79 + 0.152/k                 area fraction of rocks larger than D
///                                                          (golombek_rapp_1997)
///   N(D) = integral over D' > D of (-dF/dD') 4/(pi D'^2)   rocks per square metre
///        = 4 k q/pi [e^(-q D)/D - q E1(q D)]
///   P = 1 - e^(-N A)                                       Poisson distribution
/// Returns 1 for an abundance above 0.5: the distribution, which was fitted to counted fields, then
/// underestimates the number of large rocks (ours). The relative accuracy of N is 1e-6.
double rockHazard(double abundance, const RockCrossing& crossing);

/// Slope of the ground: rise over run eastward (dz_dx) and northward (dz_dy) [-].
struct UnseenSlope {
  double dz_dx = 0.0, dz_dy = 0.0;
};

/// Greatest distance from a cell to the elevations from which unseenSlope() computes its slope [cells].
inline constexpr int kUnseenReach = 32;

/// Returns the slope of a cell without a measured shape. Along the row and along the column of the cell, the
/// slope is the height difference of the nearest cells with an elevation on both sides, divided by their
/// distance; the ground has at least this slope somewhere in between. The slope along an axis is 0 if one
/// side has no elevation within kUnseenReach cells. NaN elevations are skipped.
UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell);

/// Measures the terrain shape and the hazards of each cell of a box, in bands of rows to limit memory. The
/// results are bit-identical to those of measuring the whole map at once. Immutable.
class SurfaceShape {
 public:
  /// Throws std::invalid_argument for options that maps::terrainMetrics() rejects.
  explicit SurfaceShape(const maps::FootprintOptions& footprint) : footprint_(footprint) {}

  /// Returns the greatest column or row offset between a cell and the cells whose shape depends on the
  /// elevation of that cell.
  int reach(const maps::Grid& grid) const;

  /// Callback with a cell of the box, its terrain shape and its hazards by the limits.
  using Visit = std::function<void(maps::Cell, const GroundShape&, Hazard)>;
  /// Calls `visit` once for each cell of a box, which must lie inside the map. After a stop request through
  /// `watch`, the remaining cells are omitted.
  void measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box, const HazardLimits& limits,
               const Visit& visit, const ProgressMonitor& watch) const;

 private:
  maps::FootprintOptions footprint_;
};

}  // namespace talus::costmap
