#include <algorithm>
#include <cmath>

#include <talus/terramech/effects/effects.hpp>

/// Effects that increase the sinkage of a wheel above z0, the sinkage under the load alone.
namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;

/// (1 - r omega/v)^2, squared share of the travel over which a braked wheel slides; 0 if r omega >= v.
double dragged(const WheelContact& c) {
  const double share = std::max(0.0, 1.0 - c.rolling);
  return share * share;
}

/// J = sin beta / (sin beta + m cos beta), from 0 to 1 at 90 deg.
double sidewaysPath(double slip_angle_rad, double width_over_length) {
  const double across = std::abs(std::sin(slip_angle_rad));
  const double along = std::max(std::cos(slip_angle_rad), 0.0);
  return across / std::max(across + width_over_length * along, 1e-300);
}

std::vector<EffectForm> driven() {
  return {
      {.name = "slip_sinkage_reece",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "z = z0 + a h i / (1 - i) where the wheel is driven, a <= 1: no more than the gaps of the "
                  "lugs hold",
       .source = "reece_1965",
       .signature = "sinkage of lugged wheels diverges towards slip 1",
       .parameters = {{"a", "-", 0.0, 1.0, 0.5}},
       .act =
           [](Input in, WheelContact& c) {
             const double i = std::clamp(in.state.slip, 0.0, 0.98);
             c.dug_m += in.parameter[0] * in.state.wheel.grouser_height_m * i / (1.0 - i);
           }},
      {.name = "slip_sinkage_linear",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "z = z0 (1 + a i) where the wheel is driven",
       .source = "ours",
       .signature = "sinkage grows in proportion to slip, drawbar pull falls",
       .parameters = {{"a", "-", 0.0, 5.0, 0.5}},
       .act = [](Input in,
                 WheelContact& c) { c.sinkage_gain += in.parameter[0] * std::max(0.0, in.state.slip); }},
      {.name = "rear_fill",
       .family = "rear_pile",
       .covariate = "slip",
       .channel = Channel::DrawbarPull,
       .formula =
           "theta_2 = -acos(1 - (kappa z + a (z - z0))/r) of a driven wheel that digs; a = 1: all of it lies "
           "behind",
       .source = "kang_2003",
       .signature = "drawbar pull of a digging wheel falls less than expected from its sinkage",
       .parameters = {{"a", "-", 0.0, 1.0, 0.5}},
       .act = [](Input in, WheelContact& c) { c.rear_fill = in.parameter[0]; }},
  };
}

std::vector<EffectForm> dragging() {
  return {
      {.name = "skid_sinkage",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "z = z0 + a r (1 - r omega / v)^2 where the wheel is braked",
       .source = "ours",
       .signature = "sinkage of a dragged wheel grows to several times its static one, drawbar pull falls",
       .parameters = {{"a", "-", 0.0, 2.0, 0.3}},
       .act = [](Input in,
                 WheelContact& c) { c.extra_sinkage_m += in.parameter[0] * c.radius_m * dragged(c); }},
      {.name = "side_ploughing",
       .family = "lateral_slip",
       .covariate = "slip_angle_rad",
       .channel = Channel::Sinkage,
       .formula =
           "z = z0 + a r J^2 as far as the wheel rolls, J = sin beta / (sin beta + m cos beta); contact "
           "behind: kappa -> 1 - (1 - kappa)(1 - J); in place of the base's n_d",
       .source = "ours",
       .signature =
           "sinkage grows with the slip angle, most towards 90 deg, drawbar pull falls, side force odd",
       .parameters = {{"a", "-", 0.0, 3.0, 0.7}, {"m", "-", 0.2, 8.0, 1.0}},
       .act =
           [](Input in, WheelContact& c) {
             const double path = sidewaysPath(in.x, in.parameter[1]);
             c.ploughed_m += in.parameter[0] * c.radius_m * path * path * (1.0 - dragged(c));
             c.rebound = 1.0 - (1.0 - c.rebound) * (1.0 - path);
             c.digging_exponent = 0.0;
           }},
  };
}

}  // namespace

std::vector<EffectForm> diggingEffects() {
  std::vector<EffectForm> all = driven();
  for (EffectForm& form : dragging()) all.push_back(std::move(form));
  return all;
}

}  // namespace talus::terramech::detail
