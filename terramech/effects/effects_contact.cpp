#include <algorithm>
#include <cmath>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;

double grown(double start, double scale, double x) {  // 0 up to start, then rises to 1
  return x <= start ? 0.0 : 1.0 - std::exp(-(x - start) / scale);
}

/// Relative increase of the shear strength by the side faces of the lugs, 0.64 (h/b) atan(b/h).
double lugSides(const Wheel& wheel) {
  return shearGain(
             {.width_m = wheel.width_m, .grouser_height_m = wheel.grouser_height_m, .lug_thrust = 1.0}) -
         1.0;
}

void strengthen(WheelContact& c, double factor) {
  c.cohesion_Pa *= std::max(factor, 0.05);
  c.tan_friction *= std::max(factor, 0.05);
}

std::vector<EffectForm> slipSinkage() {
  return {
      {.name = "slip_sinkage_ding",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "n = n0 + n1 |i|",
       .source = "ding_2010",
       .signature = "sinkage grows with slip, drawbar pull falls, torque rises",
       .parameters = {{"n1", "-", 0.0, 3.0, 0.3}},
       .act = [](Input in,
                 WheelContact& c) { c.sinkage_exponent += in.parameter[0] * std::abs(in.state.slip); }},
      {.name = "slip_sinkage_ding_quadratic",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "n = n0 + n1 |i| + n2 i^2",
       .source = "ding_2010",
       .signature = "as slip_sinkage_ding, convex or saturating in slip",
       .parameters = {{"n1", "-", -1.0, 3.0, 0.2}, {"n2", "-", -3.0, 3.0, 0.1}},
       .act =
           [](Input in, WheelContact& c) {
             const double i = std::abs(in.state.slip);
             c.sinkage_exponent =
                 std::max(0.1, c.sinkage_exponent + in.parameter[0] * i + in.parameter[1] * i * i);
           }},
      {.name = "slip_sinkage_lyasko",
       .family = "slip_sinkage",
       .covariate = "slip",
       .channel = Channel::Sinkage,
       .formula = "z = z0 (1 + i) / (1 - 0.5 i)",
       .source = "lyasko_2010",
       .signature = "sinkage grows with slip by a fixed law, drawbar pull falls",
       .parameters = {},
       .act =
           [](Input in, WheelContact& c) {
             const double i = std::abs(in.state.slip);
             c.sinkage_gain *= (1.0 + i) / (1.0 - 0.5 * i);
           }},
  };
}

std::vector<EffectForm> rate() {
  return {
      {.name = "rate_pressure_grahn",
       .family = "rate",
       .covariate = "speed_mps",
       .channel = Channel::Sinkage,
       .formula = "k -> k (v/v0)^m",
       .source = "grahn_1991",
       .signature = "sinkage falls and drawbar pull rises as a power of speed",
       .parameters = {{"m", "-", -0.5, 0.8, 0.1}, {"v0", "m/s", 1e-4, 10.0, 0.05}},
       .act =
           [](Input in, WheelContact& c) {
             c.sinkage_modulus *= std::pow(std::max(in.x, 1e-6) / in.parameter[1], in.parameter[0]);
           }},
      {.name = "rate_shear",
       .family = "rate",
       .covariate = "speed_mps",
       .channel = Channel::DrawbarPull,
       .formula = "tau -> tau (1 + a ln(v/v0))",
       .source = "grahn_1991",
       .signature = "torque and drawbar pull rise with the logarithm of speed",
       .parameters = {{"a", "-", -0.3, 0.5, 0.05}, {"v0", "m/s", 1e-4, 10.0, 0.05}},
       .act =
           [](Input in, WheelContact& c) {
             strengthen(c, 1.0 + in.parameter[0] * std::log(std::max(in.x, 1e-6) / in.parameter[1]));
           }},
      {.name = "rate_shear_slip_velocity",
       .family = "rate",
       .covariate = "speed_mps",
       .channel = Channel::DrawbarPull,
       .formula = "tau -> tau (1 + a ln(v_j/v0)), v_j = i r omega",
       .source = "ours",
       .signature = "as rate_shear, with the speed of the rim over the soil",
       .parameters = {{"a", "-", -0.3, 0.5, 0.05}, {"v0", "m/s", 1e-4, 10.0, 0.05}},
       .act =
           [](Input in, WheelContact& c) {
             const double i = std::clamp(in.state.slip, 0.0, 0.99);
             const double vj =
                 i * (std::isfinite(in.state.rim_speed_mps) ? in.state.rim_speed_mps : in.x / (1.0 - i));
             strengthen(c, 1.0 + in.parameter[0] * std::log(std::max(vj, 1e-4) / in.parameter[1]));
           }},
  };
}

std::vector<EffectForm> passes() {
  const EffectParameter gain{"a", "-", -0.8, 8.0, 0.4}, scale{"p0", "passes", 0.3, 8.0, 1.0};
  const EffectParameter first{"first", "passes", -1e3, 1e6, 1.0, false};
  return {
      {.name = "multipass_stiffness",
       .family = "multipass",
       .covariate = "pass_index",
       .channel = Channel::Sinkage,
       .formula = "k -> k (1 + a (1 - e^{-(p - first)/p0}))",
       .source = "senatore_sandu_2011",
       .signature = "sinkage falls and drawbar pull rises over the first passes",
       .parameters = {gain, scale, first},
       .act =
           [](Input in, WheelContact& c) {
             c.sinkage_modulus *= 1.0 + in.parameter[0] * grown(in.parameter[2], in.parameter[1], in.x);
           }},
      {.name = "multipass_strength",
       .family = "multipass",
       .covariate = "pass_index",
       .channel = Channel::DrawbarPull,
       .formula = "c -> c g, K -> K / g, g = 1 + a (1 - e^{-(p - first)/p0})",
       .source = "senatore_sandu_2011",
       .signature = "torque and drawbar pull rise over the first passes, sinkage nearly the same",
       .parameters = {gain, scale, first},
       .act =
           [](Input in, WheelContact& c) {
             const double g = 1.0 + in.parameter[0] * grown(in.parameter[2], in.parameter[1], in.x);
             c.cohesion_Pa *= g;
             c.shear_modulus_m /= std::max(g, 0.05);
           }},
      {.name = "multipass_compaction",
       .family = "multipass",
       .covariate = "pass_index",
       .channel = Channel::Sinkage,
       .formula = "k -> k g, c -> c g_c with g = 1 + a (1 - e^{-(p - first)/p0})",
       .source = "senatore_sandu_2011",
       .signature = "sinkage falls, torque and drawbar pull rise, saturating",
       .parameters = {gain, scale, first, {"a_c", "-", -0.8, 8.0, 0.4}},
       .act =
           [](Input in, WheelContact& c) {
             const double g = grown(in.parameter[2], in.parameter[1], in.x);
             c.sinkage_modulus *= 1.0 + in.parameter[0] * g;
             c.cohesion_Pa *= 1.0 + in.parameter[3] * g;
           }},
      {.name = "multipass_reload",
       .family = "multipass",
       .covariate = "pass_index",
       .channel = Channel::Sinkage,
       .formula = "k -> (1 + a) k, K -> K / sqrt(1 + a) from the second pass on",
       .source = "wong_2001",
       .signature = "sinkage falls at the second pass and stays, torque and drawbar pull rise at small slip",
       .parameters = {{"a", "-", -0.5, 40.0, 1.0}, first},
       .act =
           [](Input in, WheelContact& c) {
             if (in.x < in.parameter[1] + 0.5) return;
             c.sinkage_modulus *= 1.0 + in.parameter[0];
             c.shear_modulus_m /= std::sqrt(1.0 + in.parameter[0]);
           }},
  };
}

std::vector<EffectForm> wheel() {
  return {
      {.name = "grouser_shear_radius",
       .family = "grouser",
       .covariate = "grouser_height_m",
       .channel = Channel::Torque,
       .formula = "r_s = r + lambda h in shear displacement and torque",
       .source = "ding_2011",
       .signature = "torque and drawbar pull step up between smooth and lugged wheels",
       .parameters = {{"lambda", "-", 0.0, 2.0, 0.7}},
       .act = [](Input in, WheelContact& c) { c.shear_radius_m += in.parameter[0] * in.x; }},
      {.name = "grouser_thrust",
       .family = "grouser",
       .covariate = "grouser_height_m",
       .channel = Channel::DrawbarPull,
       .formula = "tau -> tau (1 + a 0.64 (h/b) atan(b/h))",
       .source = "bekker_1969",
       .signature = "drawbar pull rises with lug height, more at high slip",
       .parameters = {{"a", "-", 0.0, 5.0, 1.0}},
       .act = [](Input in,
                 WheelContact& c) { strengthen(c, 1.0 + in.parameter[0] * lugSides(in.state.wheel)); }},
      {.name = "wheel_flexibility",
       .family = "wheel_flexibility",
       .covariate = "load_N",
       .channel = Channel::DrawbarPull,
       .formula = "r* = r (1 + W / S)",
       .source = "favaedi_2011",
       .signature = "drawbar pull rises and sinkage falls, in proportion to load",
       .parameters = {{"softness", "1/N", 0.0, 0.02, 0.001}},
       .act =
           [](Input in, WheelContact& c) {
             const double ratio = 1.0 + in.parameter[0] * in.x;
             c.radius_m *= ratio;
             c.shear_radius_m *= ratio;
           }},
      {.name = "wheel_diameter",
       .family = "diameter",
       .covariate = "wheel_radius_m",
       .channel = Channel::Sinkage,
       .formula = "k -> k (D/D0)^m",
       .source = "meirion_griffith_2011",
       .signature = "sinkage differs between wheel sizes",
       .parameters = {{"m", "-", -1.0, 1.5, 0.4}, {"D0", "m", 0.01, 5.0, 0.2}},
       .act =
           [](Input in, WheelContact& c) {
             c.sinkage_modulus *= std::pow(2.0 * in.x / in.parameter[1], in.parameter[0]);
           }},
  };
}

std::vector<EffectForm> ground() {
  return {
      {.name = "elastic_rebound",
       .family = "rebound",
       .covariate = "sinkage_m",
       .channel = Channel::DrawbarPull,
       .formula = "theta_2 = -acos(1 - kappa z/r)",
       .source = "wong_reece_1967a",
       .signature = "sinkage falls and drawbar pull rises a little, with sinkage",
       .parameters = {{"kappa", "-", 0.0, 0.9, 0.1}},
       .act = [](Input in, WheelContact& c) { c.rebound = in.parameter[0]; }},
      {.name = "layered_hardpan",
       .family = "hardpan",
       .covariate = "sinkage_m",
       .channel = Channel::Sinkage,
       .formula = "sigma = k d^n + k_h max(0, d - H)",
       .source = "wong_2001",
       .signature = "sinkage stops growing below a depth, drawbar pull rises past it",
       .parameters = {{"H", "m", 1e-4, 0.3, 0.01}, {"k_h", "Pa/m", 1e4, 1e9, 1e7}},
       .act =
           [](Input in, WheelContact& c) {
             c.hard_depth_m = in.parameter[0];
             c.hard_modulus_Pa_m = in.parameter[1];
           }},
      {.name = "slope_load_transfer",
       .family = "load_transfer",
       .covariate = "slope_rad",
       .channel = Channel::DrawbarPull,
       .formula = "N = W (cos alpha - (h/L) sin alpha)",
       .source = "iagnemma_dubowsky_2004",
       .signature = "odd in slope, in every channel",
       .parameters = {{"height_over_base", "-", -2.0, 2.0, 0.3}},
       .act =
           [](Input in, WheelContact& c) {
             c.load_N *= std::max(0.05, std::cos(in.x) - in.parameter[0] * std::sin(in.x));
           }},
  };
}

/// Replaces the digging law of the base model by n = n0 + exponent |sin beta|.
void dig(WheelContact& c, double exponent, double slip_angle_rad) {
  c.digging_exponent = 0.0;
  c.sinkage_exponent += exponent * std::abs(std::sin(slip_angle_rad));
}

std::vector<EffectForm> sideSlip() {
  const auto resolve = [](Input in, WheelContact& c) { c.shear_modulus_m *= in.parameter[0]; };
  return {
      {.name = "side_slip_lateral_shear",
       .family = "lateral_slip",
       .covariate = "slip_angle_rad",
       .channel = Channel::DrawbarPull,
       .formula = "K -> K a of the shear along the resultant of j_x and j_y",
       .source = "ishigami_2007",
       .signature = "drawbar pull falls, even in the slip angle; side force odd in it",
       .parameters = {{"a", "-", 0.2, 8.0, 1.5}},
       .act = +resolve},
      {.name = "side_slip_sinkage",
       .family = "lateral_slip",
       .covariate = "slip_angle_rad",
       .channel = Channel::Sinkage,
       .formula = "n = n0 + n_y |sin beta| in place of the base's n_d",
       .source = "ours",
       .signature = "sinkage grows with the slip angle, as slip sinkage does with slip",
       .parameters = {{"n_y", "-", 0.0, 3.0, 0.3}},
       .act = [](Input in, WheelContact& c) { dig(c, in.parameter[0], in.x); }},
      {.name = "side_slip",
       .family = "lateral_slip",
       .covariate = "slip_angle_rad",
       .channel = Channel::SideForce,
       .formula = "K -> K a; n = n0 + n_y |sin beta| in place of the base's n_d",
       .source = "ishigami_2007",
       .signature = "side force odd in the slip angle; sinkage grows and drawbar pull falls, even in it",
       .parameters = {{"a", "-", 0.2, 8.0, 1.0}, {"n_y", "-", 0.0, 3.0, 0.3}},
       .act =
           [](Input in, WheelContact& c) {
             c.shear_modulus_m *= in.parameter[0];
             dig(c, in.parameter[1], in.x);
           }},
  };
}

}  // namespace

std::vector<EffectForm> contactEffects() {
  std::vector<EffectForm> all;
  for (auto part : {slipSinkage, rate, passes, wheel, ground, sideSlip})
    for (EffectForm& form : part()) all.push_back(std::move(form));
  return all;
}

}  // namespace talus::terramech::detail
