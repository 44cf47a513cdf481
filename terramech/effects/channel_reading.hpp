#pragma once

namespace talus::terramech {

/// What is measured of a wheel, as the sensors read it.
enum class Channel { DrawbarPull, Sinkage, Torque, SideForce };
inline constexpr int kChannels = 4;
inline constexpr Channel kAllChannels[] = {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque,
                                           Channel::SideForce};

/// "drawbar_pull_over_load", "sinkage_over_radius", "torque_over_load_radius", "side_force_over_load".
const char* name(Channel channel);

/// What the sensors read; the load is what they claim, the denominator of every ratio.
struct Reading {
  double load_N = 0.0;
  double radius_m = 0.0;
  double sinkage_m = 0.0;
  double dug_m = 0.0;  ///< of the model's sinkage, what the driven wheel threw behind itself; never measured
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  double side_force_N = 0.0;

  double denominator(Channel channel) const;      ///< W, r, r W or W
  double scaled(Channel channel) const;           ///< DP/W, z/r, T/(rW), F/W [-]
  void addScaled(Channel channel, double value);  ///< adds to one of them [-]
};

}  // namespace talus::terramech
