#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::terramech {

const char* name(Channel channel) {
  switch (channel) {
    case Channel::DrawbarPull:
      return "drawbar_pull_over_load";
    case Channel::Sinkage:
      return "sinkage_over_radius";
    case Channel::Torque:
      return "torque_over_load_radius";
    case Channel::SideForce:
      return "side_force_over_load";
  }
  return "";
}

double Reading::denominator(Channel channel) const {
  switch (channel) {
    case Channel::Sinkage:
      return radius_m;
    case Channel::Torque:
      return load_N * radius_m;
    case Channel::DrawbarPull:
    case Channel::SideForce:
      break;
  }
  return load_N;
}

double Reading::scaled(Channel channel) const {
  switch (channel) {
    case Channel::DrawbarPull:
      return drawbar_pull_N / load_N;
    case Channel::Sinkage:
      return sinkage_m / radius_m;
    case Channel::Torque:
      return torque_Nm / (load_N * radius_m);
    case Channel::SideForce:
      return side_force_N / load_N;
  }
  return 0.0;
}

void Reading::addScaled(Channel channel, double value) {
  switch (channel) {
    case Channel::DrawbarPull:
      drawbar_pull_N += value * load_N;
      break;
    case Channel::Sinkage:
      sinkage_m += value * radius_m;
      break;
    case Channel::Torque:
      torque_Nm += value * load_N * radius_m;
      break;
    case Channel::SideForce:
      side_force_N += value * load_N;
      break;
  }
}

}  // namespace talus::terramech
