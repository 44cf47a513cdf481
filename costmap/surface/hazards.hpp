#pragma once

#include <cstdint>

#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {

/// Limits of the terrain shape for a rover, independent of the soil. Plain data; of() computes the limits of
/// a rover.
struct HazardLimits {
  double max_gradient = 0.36;     ///< gradient above which no heading satisfies the pitch and roll limits [-]
  double max_step_m = 0.1;        ///< greatest step and relief within one wheelbase
  double max_roughness_m = 0.05;  ///< greatest rms deviation from the plane within one wheelbase
  double rock_diameter_m = 0.2;   ///< smallest rock that the rover can neither straddle nor climb
  double rock_area_m2 = 1.0;      ///< footprint that must be free of such rocks
  double max_rock_probability = 0.5;  ///< greatest accepted probability of such a rock in the footprint [-]
  double wheelbase_m = 1.0;           ///< height differences within this span are steps
  double wheel_diameter_m = 0.0;      ///< greatest distance of heights that form a step; adjacent cells form
                                      ///< steps at any distance
  double inflation_m = 0.0;  ///< clearance of the rover's centre from keep-out, impassable and unseen cells

  /// Limits of a rover: step and relief up to the ground clearance, rocks up to twice the clearance,
  /// roughness up to a third of the clearance, inflation by half the width.
  static HazardLimits of(const terramech::Rover& rover);
};

/// Returns the share of a height difference that is used as a step: min(1, wheelbase_m / span_m). span_m is
/// the width of the footprint or the distance of the two cells. A height difference across more than the
/// wheelbase is partly curvature of the ground, not an edge (ours, not from the literature).
double reliefShare(const HazardLimits& limits, double span_m);

/// Shape of the ground at a cell, from maps::TerrainMetrics.
struct GroundShape {
  float dz_dx = 0.0F;
  float dz_dy = 0.0F;
  float roughness_m = 0.0F;
  float relief_m = 0.0F;
  float step_m = 0.0F;
};

/// Spans over which a shape was measured.
struct ShapeSpans {
  double footprint_m = 0.0;  ///< diameter of the footprint
  double cell_m = 0.0;       ///< distance of adjacent cells
};

/// Finds the hazards of shapes that were measured over one footprint.
class ShapeJudge {
 public:
  ShapeJudge(const HazardLimits& limits, const ShapeSpans& spans);

  /// Slope, Step and Roughness; Unknown if a gradient is NaN.
  Hazard operator()(const GroundShape& shape) const noexcept;

 private:
  float gradient_squared_, relief_m_, step_m_, roughness_m_;
};

/// Hazards from which the whole width of the rover must keep clear.
inline constexpr Hazard kKeptClearOf = Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks | Hazard::Unknown;

/// Marks as Near all cells that have a point closer than inflation_m to a cell with a hazard of the set
/// `spreading`, and to the border of the map if the set contains Unknown.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading = kKeptClearOf);
/// Marks only cells of `box`, which must lie inside the map; inside the box, the result equals that of
/// inflate() on all cells.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading,
             const maps::CellBox& box);
/// Returns the greatest column or row offset between a cell and the cells marked for that cell.
int inflationReach(const HazardLimits& limits, double resolution_m);

}  // namespace talus::costmap
