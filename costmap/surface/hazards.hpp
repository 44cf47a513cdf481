#pragma once

#include <cstdint>

#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {

/// Limits of terrain shape and rocks for a rover, independent of the soil. Plain data; of() computes the
/// limits of a rover.
struct HazardLimits {
  /// Gradient (rise over run) above which no heading satisfies the pitch and roll limits [-].
  double max_gradient = 0.36;
  double max_step_m = 0.1;  ///< greatest allowed height step and relief within one wheelbase
  /// Greatest allowed rms deviation of the ground from the fitted plane within one wheelbase.
  double max_roughness_m = 0.05;
  /// Diameter of the smallest rock that the rover can neither straddle nor climb.
  double rock_diameter_m = 0.2;
  double rock_area_m2 = 1.0;  ///< area under the rover that must be free of such rocks
  /// Greatest accepted probability of at least one such rock in the area rock_area_m2 [-].
  double max_rock_probability = 0.5;
  /// Span within which a height difference counts fully as a step; see reliefShare().
  double wheelbase_m = 1.0;
  /// Greatest horizontal distance of two elevations that form a step. Adjacent cells form steps at any cell
  /// size.
  double wheel_diameter_m = 0.0;
  /// Clearance of the rover's centre from cells that the whole rover must avoid (kKeptClearOf).
  double inflation_m = 0.0;

  /// Returns the limits of a rover: step and relief up to the ground clearance, rocks up to twice the
  /// clearance, roughness up to a third of the clearance, inflation by half the rover's width.
  static HazardLimits of(const terramech::Rover& rover);
  /// Returns limits that no shape and no rock exceeds, for a point that only its cost restricts.
  static HazardLimits ofPoint();
};

/// Returns the share of a height difference that counts as a step: min(1, wheelbase_m / span_m). span_m [m]
/// is the width of the footprint or the distance of the two cells. A height difference over a span longer
/// than the wheelbase is partly curvature of the ground, not an edge (ours, not from the literature).
double reliefShare(const HazardLimits& limits, double span_m);

/// Terrain shape at a cell, from maps::TerrainMetrics: gradients of the fitted plane eastward and northward
/// (rise over run), rms and range of the residuals from the plane, and greatest height step.
struct GroundShape {
  float dz_dx = 0.0F;
  float dz_dy = 0.0F;
  float roughness_m = 0.0F;
  float relief_m = 0.0F;
  float step_m = 0.0F;
};

/// Horizontal spans over which a terrain shape was measured.
struct ShapeSpans {
  double footprint_m = 0.0;  ///< diameter of the footprint, i.e. of the disc of cells under the rover
  double cell_m = 0.0;       ///< distance of adjacent cells
};

/// Finds the hazards of terrain shapes that were all measured over the same spans.
class ShapeJudge {
 public:
  ShapeJudge(const HazardLimits& limits, const ShapeSpans& spans);

  /// Returns the set of Slope, Step and Roughness hazards of a shape; Unknown if a gradient is NaN.
  Hazard operator()(const GroundShape& shape) const noexcept;

 private:
  float gradient_squared_, relief_m_, step_m_, roughness_m_;
};

/// Hazards of cells that the whole width of the rover must avoid.
inline constexpr Hazard kKeptClearOf = Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks | Hazard::Unknown;

/// Adds Hazard::Near to all cells that have a point closer than limits.inflation_m to a cell with a hazard of
/// the set `spreading`. If the set contains Unknown, cells closer than limits.inflation_m to the border of
/// the map are marked, too.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading = kKeptClearOf);
/// Adds Hazard::Near like the function above, but to cells of `box` only, which must lie inside the map.
/// Inside the box, the result equals that of inflate() on all cells.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading,
             const maps::CellBox& box);
/// Returns the greatest column or row offset between a cell with a spreading hazard and the cells marked for
/// it.
int inflationReach(const HazardLimits& limits, double resolution_m);

}  // namespace talus::costmap
