#pragma once

namespace talus::terramech {

/// Measured quantity of a wheel (channel of the sensors) that a wheel model predicts.
enum class Channel { DrawbarPull, Sinkage, Torque, SideForce };
/// Number of channels. kAllChannels lists all of them in the order of Channel.
inline constexpr int kChannels = 4;
inline constexpr Channel kAllChannels[] = {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque,
                                           Channel::SideForce};

/// Returns the name of the scaled channel: "drawbar_pull_over_load", "sinkage_over_radius",
/// "torque_over_load_radius" or "side_force_over_load".
const char* name(Channel channel);

/// Sensor readings of one wheel, measured or predicted, in SI units. The scaled channels are the ratios DP/W
/// (drawbar pull), z/r (sinkage), T/(rW) (torque) and F/W (side force), with W = load_N and r = radius_m.
struct Reading {
  double load_N = 0.0;     ///< nominal load W
  double radius_m = 0.0;   ///< wheel radius r
  double sinkage_m = 0.0;  ///< sinkage z
  double dug_m = 0.0;      ///< part of the model's sinkage that a driven wheel excavates; not a measurement
  double torque_Nm = 0.0;  ///< torque T about the axle
  double drawbar_pull_N = 0.0;  ///< drawbar pull DP
  double side_force_N = 0.0;    ///< side force F

  double denominator(Channel channel) const;      ///< returns r for sinkage, r W for torque, otherwise W
  double scaled(Channel channel) const;           ///< returns the scaled channel [-]
  void addScaled(Channel channel, double value);  ///< adds `value` [-] to the scaled channel
};

}  // namespace talus::terramech
