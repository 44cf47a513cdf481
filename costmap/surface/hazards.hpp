#pragma once

#include <cstdint>

#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {

/// What the ground's shape may be before a rover is stopped by it, whatever the soil. Plain data; of() fills
/// it from a rover.
struct HazardLimits {
  double max_gradient = 0.36;     ///< steeper than this no heading keeps pitch and roll in bounds [-]
  double max_step_m = 0.1;        ///< highest step and relief within one wheelbase, of the belly's clearance
  double max_roughness_m = 0.05;  ///< rms departure from the plane within one wheelbase
  double rock_diameter_m = 0.2;   ///< smallest rock that it cannot straddle or climb
  double rock_area_m2 = 1.0;      ///< footprint that must be free of such rocks
  double max_rock_probability = 0.5;  ///< refuse where such a rock is likelier than this [-]
  double wheelbase_m = 1.0;           ///< span over which relief counts as a step
  double wheel_diameter_m = 0.0;      ///< heights this far apart make a step; neighbouring cells always do
  double inflation_m = 0.0;           ///< keep the centre this far from keep-out, impassable and unseen cells

  /// Limits of a rover: step and rock height up to its clearance, roughness up to a third of it, half its
  /// width kept free.
  static HazardLimits of(const terramech::Rover& rover);
};

/// Relief within one wheelbase: what the plane does not explain over a footprint larger than the rover, or what two
/// neighbouring cells further apart than the wheelbase differ by, is bending of the ground rather than an edge, and
/// counts in proportion (ours, not from the literature). Factor in (0, 1].
double reliefShare(const HazardLimits& limits, double span_m);

/// The shape of the ground at a cell, as maps::TerrainMetrics has it.
struct GroundShape {
  float dz_dx = 0.0F;
  float dz_dy = 0.0F;
  float roughness_m = 0.0F;
  float relief_m = 0.0F;
  float step_m = 0.0F;
};

/// Over what a shape was measured.
struct ShapeSpans {
  double footprint_m = 0.0;  ///< width of the disc
  double cell_m = 0.0;       ///< between neighbouring cells
};

/// Judges shapes measured over one footprint.
class ShapeJudge {
 public:
  ShapeJudge(const HazardLimits& limits, const ShapeSpans& spans);

  /// Slope, Step, Roughness; Unknown where a gradient is NaN.
  Hazard operator()(const GroundShape& shape) const noexcept;

 private:
  float gradient_squared_, relief_m_, step_m_, roughness_m_;
};

/// Hazards that the rover's whole width must keep clear of.
inline constexpr Hazard kKeptClearOf = Hazard::KeepOut | Hazard::Obstacle | Hazard::Rocks | Hazard::Unknown;

/// Marks as Near the cells some place of which lies closer than inflation_m to a cell with one of these hazards; where
/// Unknown is one of them, to the outside of the map, too.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading = kKeptClearOf);
/// The same in a box inside the map alone: equal there to doing it everywhere.
void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading,
             const maps::CellBox& box);
/// Columns and rows, at most, from a cell that spreads to those marked for it.
int inflationReach(const HazardLimits& limits, double resolution_m);

}  // namespace talus::costmap
