#include <talus/costmap/drive_state.hpp>

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
    case Refusal::Torque:
      return "required torque above the motor limit";
    case Refusal::Sinkage:
      return "sinkage above the ground clearance";
    case Refusal::Category:
      return "category at this slope excluded by the policy";
  }
  return "";
}

}  // namespace talus::costmap
