#pragma once

#include <cstdint>
#include <string>

#include <talus/terramech/mobility/category.hpp>

namespace talus::costmap {

/// Reason for which a motion over a cell in one heading is refused, i.e. has infinite cost.
enum class Refusal : std::uint8_t {
  None,       ///< the motion is allowed
  Unknown,    ///< the cell is unobserved
  Blocked,    ///< a hazard of the cell refuses every heading; the map has the hazard
  Pitch,      ///< the gradient along the heading exceeds the pitch limit
  Roll,       ///< the gradient across the heading exceeds the roll limit
  Pull,       ///< the required drawbar pull exceeds the available drawbar pull
  SideForce,  ///< the required side force exceeds the side force that is available at the required pull
  Torque,     ///< the required torque exceeds the torque of the motors
  Sinkage,    ///< the wheels sink so deep that the belly touches the ground
  Category,   ///< the policy does not allow the category of the ground at this slope
  Tips,       ///< the rover tips: the centre of mass is beyond the line between wheel contacts
};

/// Returns the reason as text, e.g. "required drawbar pull above the available drawbar pull".
const char* toText(Refusal refusal) noexcept;

/// State of a rover that drives over ground of one estimated strength at one gradient: the quantities from
/// which the cost follows. Quantities are those of the rover unless marked "per wheel". Metres are
/// horizontal.
struct TravelState {
  float slip = 0.0F;            ///< slip [-]; positive for driven, negative for braked wheels
  float sinkage_m = 0.0F;       ///< sinkage, per wheel
  float torque_Nm = 0.0F;       ///< torque, per wheel
  float energy_J_per_m = 0.0F;  ///< drive and hotel energy; expected value over the strengths that hold
  float time_s_per_m = 0.0F;    ///< driving time; expected value over the strengths that hold
  /// Hazard rate of immobilisation [1/m]: the probability of immobilisation over d metres is 1 -
  /// exp(-risk_per_m d).
  float risk_per_m = 0.0F;
  float weak = 0.0F;  ///< probability that the available pull is below the required pull, 0 to 1 [-]
  /// Available drawbar pull over load DP/W at the reference slip 0.5 minus the required DP/W [-].
  float pull_margin = 0.0F;
  /// Category of the ground at this gradient along the heading.
  terramech::Category category = terramech::Category::Unknown;
  Refusal refusal = Refusal::None;
  std::uint8_t class_index = 0;  ///< index of the terrain class of the ground in the model
};

/// Returns the less favourable value of each quantity of `a` and `b`. The refusal is that of `a`, or that of
/// `b` if `a` is allowed.
TravelState worse(const TravelState& a, const TravelState& b) noexcept;

/// Returns the state interpolated linearly from `a` (share = 0) to `b` (share = 1). The category is the worse
/// of both. The refusal is Tips if either state tips, otherwise that of `a`, or that of `b` if `a` is
/// allowed.
TravelState between(const TravelState& a, const TravelState& b, float share) noexcept;

}  // namespace talus::costmap
