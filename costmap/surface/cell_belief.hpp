#pragma once

#include <cstdint>

namespace talus::costmap {

/// Hazards of a cell: reasons other than the soil for which a cell is refused (may not be entered) or its
/// category is lowered. A value is a set of bits.
enum class Hazard : std::uint8_t {
  None = 0,
  Unknown = 1,    ///< no elevation, no terrain class, no measurable shape, or no data in a cost layer
  Slope = 2,      ///< the gradient exceeds the limit for every heading
  Step = 4,       ///< a step or the relief under the wheels exceeds the ground clearance
  Roughness = 8,  ///< the roughness exceeds the clearance of the belly
  Rocks = 16,     ///< the probability of a rock too large to cross is too high
  KeepOut = 32,   ///< the cell lies in a keep-out polygon, or has an infinite cost in a layer
  Obstacle = 64,  ///< the terrain class has no soil, or the ground was declared impassable
  Near = 128,     ///< the cell is closer than half the rover's width to a cell that the rover must avoid
};

constexpr Hazard operator|(Hazard a, Hazard b) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr Hazard& operator|=(Hazard& a, Hazard b) noexcept {
  return a = a | b;
}

/// Returns true if the set `set` contains the hazard `one`.
constexpr bool has(Hazard set, Hazard one) noexcept {
  return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(one)) != 0;
}

/// Estimate of one cell, stored in the octree. It contains the strength of the ground, from the prior of the
/// terrain class and from wheel evidence, and the category of the cell, which is the worst over all headings.
struct CellBelief {
  float pull_mean = 0.0F;     ///< mean drawbar pull over load DP/W at slip 0.5 [-]
  float pull_std = 0.0F;      ///< standard deviation of pull_mean [-]
  float sinkage_mean = 0.0F;  ///< mean sinkage over wheel radius z/r at slip 0.5 [-]
  float sinkage_std = 0.0F;   ///< standard deviation of sinkage_mean [-]
  /// Number of pull readings in the block of the cell, each weighted by its certainty [-]; 0: no evidence. A
  /// block is a square of cells that stores its evidence together.
  float evidence = 0.0F;
  float evidence_pull = 0.0F;      ///< DP/W of the weakest part of the readings [-]
  float evidence_sinkage = 0.0F;   ///< z/r of the deepest part of the readings [-]; 0: not measured
  std::uint32_t updated_s = 0;     ///< telemetry time of the newest reading, rounded down [s]
  std::uint8_t terrain_class = 0;  ///< number of the terrain class in the class raster; 0 without a raster
  std::uint8_t category = 3;       ///< terramech::Category as a number: safe, marginal, dangerous, unknown
  std::uint8_t confidence = 0;     ///< probability of the category in steps of 1/16; 16 = certain
  Hazard hazards = Hazard::None;   ///< set of hazards of the cell

  friend bool operator==(const CellBelief&, const CellBelief&) = default;
};

}  // namespace talus::costmap
