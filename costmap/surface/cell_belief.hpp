#pragma once

#include <cstdint>

namespace talus::costmap {

/// Reasons other than the soil for which a cell is refused or ranked lower; a cell may have several.
enum class Hazard : std::uint8_t {
  None = 0,
  Unknown = 1,    ///< no elevation there
  Slope = 2,      ///< steeper than the rover may stand in any heading
  Step = 4,       ///< higher edge under the wheels than the rover clears
  Roughness = 8,  ///< the ground departs from its plane by more than the belly clears
  Rocks = 16,     ///< rocks that it cannot cross are too likely
  KeepOut = 32,   ///< inside a keep-out polygon
  Obstacle = 64,  ///< the terrain class is declared impassable
  Near = 128,     ///< the footprint would touch a refused cell
};

constexpr Hazard operator|(Hazard a, Hazard b) noexcept {
  return static_cast<Hazard>(static_cast<std::uint8_t>(a) | static_cast<std::uint8_t>(b));
}
constexpr Hazard& operator|=(Hazard& a, Hazard b) noexcept {
  return a = a | b;
}

/// Whether the set holds the hazard.
constexpr bool has(Hazard set, Hazard one) noexcept {
  return (static_cast<std::uint8_t>(set) & static_cast<std::uint8_t>(one)) != 0;
}

/// What is believed of one cell: the strength of its ground, from the prior of its terrain class and from the
/// wheels that drove on or near it, and the category that follows for people (worst case over headings). The
/// payload of the tree.
struct CellBelief {
  float pull_mean = 0.0F;     ///< drawbar pull over load at the reference slip 0.5 [-], posterior mean
  float pull_std = 0.0F;      ///< its standard deviation [-]
  float sinkage_mean = 0.0F;  ///< sinkage over wheel radius at the reference slip [-], posterior mean
  float sinkage_std = 0.0F;   ///< its standard deviation [-]
  /// Samples in its block, each weighed by its certainty [-]; 0 = nobody drove there.
  float evidence = 0.0F;
  float evidence_pull = 0.0F;      ///< drawbar pull over load of the weakest part of them [-]
  float evidence_sinkage = 0.0F;   ///< sinkage over radius of the deepest [-]; 0: none was measured
  std::uint32_t updated_s = 0;     ///< telemetry time of the newest sample, rounded down [s]
  std::uint8_t terrain_class = 0;  ///< number in the terrain-class raster; 0 where there is none
  std::uint8_t category = 3;       ///< terramech::Category as a number: safe, marginal, dangerous, unknown
  std::uint8_t confidence = 0;     ///< probability of that category in steps of 1/16, 16 = certain
  Hazard hazards = Hazard::None;   ///< what else stands against it

  friend bool operator==(const CellBelief&, const CellBelief&) = default;
};

/// Whether it speaks for a floor beneath the top surface: wheels spoke for it, its shape is not known. Such a
/// leaf stands for its own voxel and is never merged with others.
inline bool ofFloor(const CellBelief& belief) noexcept {
  return belief.evidence > 0.0F && has(belief.hazards, Hazard::Unknown);
}

}  // namespace talus::costmap
