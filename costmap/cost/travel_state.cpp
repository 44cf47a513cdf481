#include <algorithm>
#include <cmath>

#include <talus/costmap/cost/travel_state.hpp>

namespace talus::costmap {

const char* toText(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::None:
      return "allowed";
    case Refusal::Unknown:
      return "unobserved cell";
    case Refusal::Blocked:
      return "blocked for any heading";
    case Refusal::Pitch:
      return "slope along the heading above the pitch limit";
    case Refusal::Roll:
      return "slope across the heading above the roll limit";
    case Refusal::Pull:
      return "required drawbar pull above the available drawbar pull";
    case Refusal::SideForce:
      return "required side force above the available side force";
    case Refusal::Torque:
      return "required torque above the motor limit";
    case Refusal::Sinkage:
      return "sinkage above the ground clearance";
    case Refusal::Category:
      return "category at this slope excluded by the policy";
    case Refusal::Tips:
      return "tips: centre of mass past the wheels";
  }
  return "";
}

TravelState worse(const TravelState& a, const TravelState& b) noexcept {
  const auto farther = [](float x, float y) { return std::abs(x) < std::abs(y) ? y : x; };
  return {.slip = farther(a.slip, b.slip),
          .sinkage_m = std::max(a.sinkage_m, b.sinkage_m),
          .torque_Nm = farther(a.torque_Nm, b.torque_Nm),
          .energy_J_per_m = std::max(a.energy_J_per_m, b.energy_J_per_m),
          .time_s_per_m = std::max(a.time_s_per_m, b.time_s_per_m),
          .risk_per_m = std::max(a.risk_per_m, b.risk_per_m),
          .weak = std::max(a.weak, b.weak),
          .pull_margin = std::min(a.pull_margin, b.pull_margin),
          .category = std::max(a.category, b.category),
          .refusal = a.refusal != Refusal::None ? a.refusal : b.refusal,
          .class_index = a.class_index};
}

TravelState between(const TravelState& a, const TravelState& b, float share) noexcept {
  TravelState out = a;
  for (const auto number :
       {&TravelState::slip, &TravelState::sinkage_m, &TravelState::torque_Nm, &TravelState::energy_J_per_m,
        &TravelState::time_s_per_m, &TravelState::risk_per_m, &TravelState::weak, &TravelState::pull_margin})
    out.*number = a.*number + share * (b.*number - a.*number);
  out.category = std::max(a.category, b.category);
  if (out.refusal == Refusal::None || b.refusal == Refusal::Tips) out.refusal = b.refusal;
  return out;
}

}  // namespace talus::costmap
