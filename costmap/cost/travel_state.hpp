#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <talus/terramech/mobility/category.hpp>

namespace talus::costmap {

/// Reason for refusing a motion over a cell.
enum class Refusal : std::uint8_t {
  None,       ///< allowed
  Unknown,    ///< the cell is unobserved
  Blocked,    ///< a hazard for every heading; the map has the reason
  Pitch,      ///< gradient along the heading above the pitch limit
  Roll,       ///< gradient across the heading above the roll limit
  Pull,       ///< required drawbar pull above the available drawbar pull
  SideForce,  ///< required side force above the available side force at the required pull
  Torque,     ///< required torque above the torque of the motors
  Sinkage,    ///< sinkage at which the belly touches the ground
  Category,   ///< category at this slope not allowed by the policy
  Tips,       ///< centre of mass beyond the wheel base
};

/// Returns the text of a reason, e.g. "required drawbar pull above the available drawbar pull".
const char* toText(Refusal refusal) noexcept;

/// State of driving over one kind of ground at one gradient: the quantities from which a cost follows.
/// Quantities are those of the rover unless marked "per wheel"; metres are horizontal.
struct TravelState {
  float slip = 0.0F;            ///< [-], driven > 0, braked < 0
  float sinkage_m = 0.0F;       ///< per wheel
  float torque_Nm = 0.0F;       ///< per wheel
  float energy_J_per_m = 0.0F;  ///< drive and hotel power, expectation over the soil uncertainty
  float time_s_per_m = 0.0F;    ///< expectation over the soil uncertainty
  float risk_per_m = 0.0F;      ///< hazard rate of immobilisation: P over d metres = 1 - exp(-risk_per_m d)
  float weak = 0.0F;            ///< probability that the available pull is below the required pull, 0 to 1
  float pull_margin = 0.0F;     ///< DP/W at the reference slip minus the required DP/W [-]
  terramech::Category category = terramech::Category::Unknown;  ///< at this gradient along the heading
  Refusal refusal = Refusal::None;
  std::uint8_t class_index = 0;  ///< index of the ground's class in the model
};

/// Returns the less favourable value of each quantity; the refusal of `b` only if `a` is allowed.
TravelState worse(const TravelState& a, const TravelState& b) noexcept;

/// Interpolates linearly from a (share = 0) to b (share = 1). The category is the worse of both. The refusal
/// is Tips if either state tips, else that of `a`, else that of `b`.
TravelState between(const TravelState& a, const TravelState& b, float share) noexcept;

/// States of a curve over the gradient along, at the bins of TravelCurve.
using TravelTable = std::array<TravelState, 512>;

}  // namespace talus::costmap
