#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <talus/terramech/mobility/category.hpp>

namespace talus::costmap {

/// Why a motion over a cell is refused.
enum class Refusal : std::uint8_t {
  None,       ///< allowed
  Unknown,    ///< the cell is unobserved
  Blocked,    ///< a hazard that no heading avoids; the map knows which
  Pitch,      ///< steeper along the heading than the rover may pitch
  Roll,       ///< steeper across the heading than the rover may roll
  Pull,       ///< required drawbar pull above the available drawbar pull
  SideForce,  ///< required side force above the available side force, with the pull that is required
  Torque,     ///< the motors cannot give the torque
  Sinkage,    ///< the wheels sink to where the belly touches
  Category,   ///< the category at this slope is refused by the policy
  Tips,       ///< the centre of mass passes over the wheels
};

/// The reason of a refusal as text: "required drawbar pull above the available drawbar pull".
const char* toText(Refusal refusal) noexcept;

/// What driving over one kind of ground at one gradient is like: the numbers behind a cost. A wheel's worth
/// where it is of a wheel, else the rover's. Metres are horizontal.
struct DriveState {
  float slip = 0.0F;            ///< [-], driven > 0, braked < 0
  float sinkage_m = 0.0F;       ///< of a wheel
  float torque_Nm = 0.0F;       ///< on a wheel
  float energy_J_per_m = 0.0F;  ///< drive and hotel, expected over the belief
  float time_s_per_m = 0.0F;    ///< expected over the belief
  float risk_per_m = 0.0F;      ///< hazard rate of immobilisation: P over d metres = 1 - exp(-risk_per_m d)
  float weak = 0.0F;            ///< probability that the ground gives less than is asked, 0 to 1
  float pull_margin = 0.0F;     ///< drawbar pull over load at the reference slip minus the slope's demand [-]
  terramech::Category category = terramech::Category::Unknown;  ///< at this gradient along the heading
  Refusal refusal = Refusal::None;
  std::uint8_t class_index = 0;  ///< of the ground, in the model's classes
};

/// The worse of two states in each of their numbers; the first refusal of the two.
DriveState worse(const DriveState& a, const DriveState& b) noexcept;

/// A state on the way from one to another, share in [0, 1]: numbers linear between both, the worse category, the first
/// refusal of the two but for tipping, which no ground mends.
DriveState between(const DriveState& a, const DriveState& b, float share) noexcept;

/// A curve's numbers over the gradient, the bins of DriveCurve.
using DriveTable = std::array<DriveState, 512>;

}  // namespace talus::costmap
