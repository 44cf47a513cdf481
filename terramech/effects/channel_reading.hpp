#pragma once

namespace talus::terramech {

/// Measured quantities of a wheel, as the sensors read them.
enum class Channel { DrawbarPull, Sinkage, Torque, SideForce };
/// Number of channels.
inline constexpr int kChannels = 4;
inline constexpr Channel kAllChannels[] = {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque,
                                           Channel::SideForce};

/// Returns "drawbar_pull_over_load", "sinkage_over_radius", "torque_over_load_radius" or
/// "side_force_over_load".
const char* name(Channel channel);

/// Sensor readings of one wheel, SI. load_N is the nominal load and the denominator of the force and torque
/// ratios.
struct Reading {
  double load_N = 0.0;
  double radius_m = 0.0;
  double sinkage_m = 0.0;
  double dug_m = 0.0;  ///< component of the model's sinkage that a driven wheel excavates; not a measurement
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  double side_force_N = 0.0;

  double denominator(Channel channel) const;      ///< r for sinkage, r W for torque, otherwise W
  double scaled(Channel channel) const;           ///< ratio DP/W (pull), z/r, T/(rW) or F/W (side force) [-]
  void addScaled(Channel channel, double value);  ///< adds to the scaled channel [-]
};

}  // namespace talus::terramech
