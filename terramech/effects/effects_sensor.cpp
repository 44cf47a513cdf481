#include <cmath>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;

double turning(const WheelState& state) {
  return state.slip > -1.0 ? 1.0 : 0.0;
}

std::vector<EffectForm> torque() {
  return {
      {.name = "torque_offset",
       .family = "torque_sensor",
       .covariate = "load_N",
       .channel = Channel::Torque,
       .formula = "T_m = T + T0",
       .source = "ojeda_2006",
       .signature = "torque alone; over load as 1/W",
       .parameters = {{"T0", "Nm", -20.0, 20.0, 0.2}},
       .read = [](Input in, const WheelContact&,
                  Reading& r) { r.torque_Nm += in.parameter[0] * turning(in.state); }},
      {.name = "torque_offset_viscous",
       .family = "torque_sensor",
       .covariate = "rim_speed_mps",
       .channel = Channel::Torque,
       .formula = "T_m = T + T0 + b v_rim",
       .source = "ojeda_2006",
       .signature = "torque alone, growing with the rim's speed",
       .parameters = {{"T0", "Nm", -20.0, 20.0, 0.1}, {"b", "Nm s/m", -500.0, 500.0, 1.0}},
       .read = [](Input in, const WheelContact&,
                  Reading& r) { r.torque_Nm += in.parameter[0] + in.parameter[1] * in.x; }},
      {.name = "torque_efficiency",
       .family = "torque_sensor",
       .covariate = "constant",
       .channel = Channel::Torque,
       .formula = "T_m = T / eta",
       .source = "ojeda_2006",
       .signature = "torque alone, in proportion to itself",
       .parameters = {{"eta", "-", 0.3, 2.0, 0.9}},
       .read = [](Input in, const WheelContact&, Reading& r) { r.torque_Nm /= in.parameter[0]; }},
  };
}

}  // namespace

std::vector<EffectForm> sensorEffects() {
  std::vector<EffectForm> all = torque();
  all.push_back({.name = "load_cell_tilt",
                 .family = "load_cell_tilt",
                 .covariate = "constant",
                 .channel = Channel::DrawbarPull,
                 .formula = "DP_m = DP cos e + W sin e",
                 .source = "ours",
                 .signature = "a constant offset of DP/W alone",
                 .parameters = {{"e", "rad", -0.35, 0.35, 0.02}},
                 .read = [](Input in, const WheelContact&, Reading& r) {
                   const double e = in.parameter[0];
                   r.drawbar_pull_N = r.drawbar_pull_N * std::cos(e) + r.load_N * std::sin(e);
                 }});
  all.push_back(
      {.name = "drawbar_zero",
       .family = "load_cell_tilt",
       .covariate = "load_N",
       .channel = Channel::DrawbarPull,
       .formula = "DP_m = DP + F0",
       .source = "ours",
       .signature = "DP/W alone, as 1/W",
       .parameters = {{"F0", "N", -500.0, 500.0, 1.0}},
       .read = [](Input in, const WheelContact&, Reading& r) { r.drawbar_pull_N += in.parameter[0]; }});
  all.push_back({.name = "sinkage_datum",
                 .family = "sinkage_datum",
                 .covariate = "constant",
                 .channel = Channel::Sinkage,
                 .formula = "z_m = z + z0",
                 .source = "ours",
                 .signature = "a constant offset of the sinkage alone",
                 .parameters = {{"z0", "m", -0.05, 0.05, 0.002}},
                 .read = [](Input in, const WheelContact&, Reading& r) { r.sinkage_m += in.parameter[0]; }});
  all.push_back({.name = "slip_bias",
                 .family = "slip_bias",
                 .covariate = "slip",
                 .channel = Channel::DrawbarPull,
                 .formula = "1 - i = (1 - i_m)/(1 + e)",
                 .source = "ours",
                 .signature = "every channel, where it is steep in slip (low slip)",
                 .parameters = {{"e", "-", -0.3, 0.3, 0.05}},
                 .act = [](Input in, WheelContact& c) {
                   if (c.slip >= 0.0)
                     c.slip = std::fmax(-0.9, 1.0 - (1.0 - c.slip) / (1.0 + in.parameter[0]));
                 }});
  for (EffectForm& form : all) form.of_sensor = true;
  return all;
}

}  // namespace talus::terramech::detail
