#pragma once

#include <cstdint>

namespace talus::costmap {

/// Reasons other than the soil for which a cell is refused or its category lowered; a bit set.
enum class Hazard : std::uint8_t {
  None = 0,
  Unknown = 1,    ///< no elevation, no terrain class, no measurable shape, or no data in a cost layer
  Slope = 2,      ///< gradient above the limit for any heading
  Step = 4,       ///< step or relief under the wheels above the ground clearance
  Roughness = 8,  ///< roughness above the clearance of the belly
  Rocks = 16,     ///< rocks too large to cross are too probable
  KeepOut = 32,   ///< keep-out polygon, or infinite cost in a layer
  Obstacle = 64,  ///< terrain class without a soil, or a place declared impassable
  Near = 128,     ///< closer to a refused cell than half the rover's width
};

constexpr Hazard operator|(Hazard a, Hazard b) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr Hazard& operator|=(Hazard& a, Hazard b) noexcept {
  return a = a | b;
}

/// True if the set contains the hazard.
constexpr bool has(Hazard set, Hazard one) noexcept {
  return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(one)) != 0;
}

/// Estimate of one cell: the strength of the ground from the prior of the terrain class and from wheel
/// evidence, and the category, which is the worst over all headings. Payload of the octree.
struct CellBelief {
  float pull_mean = 0.0F;     ///< drawbar pull over load DP/W at slip 0.5 [-], mean
  float pull_std = 0.0F;      ///< standard deviation of pull_mean [-]
  float sinkage_mean = 0.0F;  ///< sinkage over radius z/r at slip 0.5 [-], mean
  float sinkage_std = 0.0F;   ///< standard deviation of sinkage_mean [-]
  /// Samples in the cell's block, each weighted by its certainty [-]; 0: no evidence.
  float evidence = 0.0F;
  float evidence_pull = 0.0F;      ///< DP/W of the weakest part of the samples [-]
  float evidence_sinkage = 0.0F;   ///< z/r of the deepest sample [-]; 0: not measured
  std::uint32_t updated_s = 0;     ///< telemetry time of the newest sample, rounded down [s]
  std::uint8_t terrain_class = 0;  ///< number in the terrain-class raster; 0 without a raster
  std::uint8_t category = 3;       ///< terramech::Category as a number: safe, marginal, dangerous, unknown
  std::uint8_t confidence = 0;     ///< probability of the category in steps of 1/16; 16 = certain
  Hazard hazards = Hazard::None;   ///< hazards of the cell

  friend bool operator==(const CellBelief&, const CellBelief&) = default;
};

/// True if the estimate belongs to a floor beneath the top surface: evidence exists, and the shape is
/// unknown. The leaf of a floor represents one voxel and is never merged.
inline bool ofFloor(const CellBelief& belief) noexcept {
  return belief.evidence > 0.0F && has(belief.hazards, Hazard::Unknown);
}

}  // namespace talus::costmap
