#include <talus/costmap/drive_state.hpp>

namespace talus::costmap {

const char* toText(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::None:
      return "allowed";
    case Refusal::Unknown:
      return "nobody has seen this cell";
    case Refusal::Blocked:
      return "blocked whatever the heading";
    case Refusal::Pitch:
      return "steeper along the heading than the rover may pitch";
    case Refusal::Roll:
      return "steeper across the heading than the rover may roll";
    case Refusal::Pull:
      return "the soil cannot give the pull that the slope asks for";
    case Refusal::Torque:
      return "the motors cannot give the torque";
    case Refusal::Sinkage:
      return "the wheels sink until the belly touches";
    case Refusal::Category:
      return "the category at this slope is refused by the policy";
  }
  return "";
}

}  // namespace talus::costmap
