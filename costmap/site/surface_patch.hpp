#pragma once

#include <cstdint>
#include <vector>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::costmap {

/// Sum of the external costs per metre (CostLayer) in each cell, quantised so that similar cells share one cost
/// curve. The sum is rounded up by at most a fifth, to two digits out of 10, 11, 12, 13, 15, 16, 18, 20, 22,
/// 25, 28, 30, 35, 40, 45, 50, 60, 70, 80, 90; positive sums below 0.1 J/m are raised to 0.1 J/m. Steps are
/// equal on all maps, so that a cost in one cell never lowers the cost of another. Infinite costs are
/// omitted, because their cells have Hazard::KeepOut. Immutable.
class AddedCost {
 public:
  explicit AddedCost(const std::vector<CostLayer>& layers);

  /// Returns the step (quantised cost) of a cell; 0: no added cost.
  int step(maps::Cell cell) const { return steps_.empty() ? 0 : steps_[cell]; }
  /// Returns the added cost of a step [J/m], which increases with the step.
  static double J_per_m(int step) noexcept;

 private:
  maps::Raster<std::uint8_t> steps_;
};

/// Limit of the magnitude of elevations [m]; below this limit, single precision resolves at least 1/64 m. No
/// planetary surface exceeds the limit.
inline constexpr double kHighest_m = 131072.0;

/// Returns the cells of a map that a patch (new observation of a window) covers. `any_height` is true if the
/// map has an elevation. Throws std::invalid_argument, with location and remedy, if the patch has another
/// resolution, is not aligned with the cells, extends beyond the map's edge, has layers on different grids,
/// has no content, or has an invalid value.
maps::CellBox placeOf(const SurfacePatch& patch, const GroundSite& site, bool any_height);

/// Checks the layers of a map. Throws std::invalid_argument, with location and remedy, if an elevation or
/// rock abundance is invalid: an invalid value would be read as no hazard or as no data.
void requirePossible(const MapLayers& layers);

/// Returns the middle of the range of the elevations [m]; 0 if there are no elevations. As the base of the
/// octree, this value keeps all elevations inside the octree.
double middleElevation(const maps::Raster<float>& elevation_m);

}  // namespace talus::costmap
