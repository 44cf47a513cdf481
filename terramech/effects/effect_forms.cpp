#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/effects/refined_model.hpp>

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

constexpr EffectParameter kGain{"a", "-", -0.8, 8.0, 0.4}, kPasses{"p0", "passes", 0.3, 8.0, 1.0};
constexpr EffectParameter kFirst{"first", "passes", -1e3, 1e6, 1.0, false};

/// Replaces the digging law of the base model by n = n0 + exponent |sin beta|.
void dig(WheelContact& c, double exponent, double slip_angle_rad) {
  c.digging_exponent = 0.0;
  c.sinkage_exponent += exponent * std::abs(std::sin(slip_angle_rad));
}

const EffectForm kContactForms[] = {
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
    {.name = "multipass_stiffness",
     .family = "multipass",
     .covariate = "pass_index",
     .channel = Channel::Sinkage,
     .formula = "k -> k (1 + a (1 - e^{-(p - first)/p0}))",
     .source = "senatore_sandu_2011",
     .signature = "sinkage falls and drawbar pull rises over the first passes",
     .parameters = {kGain, kPasses, kFirst},
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
     .parameters = {kGain, kPasses, kFirst},
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
     .parameters = {kGain, kPasses, kFirst, {"a_c", "-", -0.8, 8.0, 0.4}},
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
     .parameters = {{"a", "-", -0.5, 40.0, 1.0}, kFirst},
     .act =
         [](Input in, WheelContact& c) {
           if (in.x < in.parameter[1] + 0.5) return;
           c.sinkage_modulus *= 1.0 + in.parameter[0];
           c.shear_modulus_m /= std::sqrt(1.0 + in.parameter[0]);
         }},
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
    {.name = "side_slip_lateral_shear",
     .family = "lateral_slip",
     .covariate = "slip_angle_rad",
     .channel = Channel::DrawbarPull,
     .formula = "K -> K a of the shear along the resultant of j_x and j_y",
     .source = "ishigami_2007",
     .signature = "drawbar pull falls, even in the slip angle; side force odd in it",
     .parameters = {{"a", "-", 0.2, 8.0, 1.5}},
     .act = [](Input in, WheelContact& c) { c.shear_modulus_m *= in.parameter[0]; }},
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

}  // namespace

std::vector<EffectForm> contactEffects() {
  return {std::begin(kContactForms), std::end(kContactForms)};
}

/// Effects that increase the sinkage of a wheel above z0, the sinkage under the load alone.

namespace {

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

const EffectForm kDiggingForms[] = {
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
     .formula = "z = z0 + a r J^2 as far as the wheel rolls, J = sin beta / (sin beta + m cos beta); contact "
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

}  // namespace

std::vector<EffectForm> diggingEffects() {
  return {std::begin(kDiggingForms), std::end(kDiggingForms)};
}

namespace {

// Parameters of every drift: a, start, span, then those of the shape; u = (x - start) / span.
double phase(Input in) {
  return (in.x - in.parameter[1]) / in.parameter[2];
}
double linear(Input in) {
  return in.parameter[0] * phase(in);
}
double relaxing(Input in) {
  return in.parameter[0] * (1.0 - std::exp(-phase(in) / in.parameter[3]));
}
double wave(Input in) {
  return in.parameter[0] * std::sin(2.0 * std::numbers::pi * phase(in) / in.parameter[3] + in.parameter[4]);
}

template <double (*Shape)(Input)>
void cohesion(Input in, WheelContact& c) {
  c.cohesion_Pa *= std::max(0.0, 1.0 + Shape(in));
}
template <double (*Shape)(Input)>
void friction(Input in, WheelContact& c) {
  c.tan_friction *= std::max(0.02, 1.0 + Shape(in));
}
template <double (*Shape)(Input)>
void stiffness(Input in, WheelContact& c) {
  c.sinkage_modulus *= std::exp(std::clamp(Shape(in), -5.0, 5.0));
}
template <double (*Shape)(Input), Channel channel>
void zero(Input in, const WheelContact&, Reading& r) {
  r[channel] += Shape(in);
}

struct Target {
  const char* unit;
  double low, high, typical;
};

std::vector<EffectParameter> shapeParameters(const Target& t, int shape) {
  std::vector<EffectParameter> p{{"a", t.unit, t.low, t.high, t.typical},
                                 {"start", "of covariate", -1e300, 1e300, 0.0, false},
                                 {"span", "of covariate", 1e-300, 1e300, 1.0, false}};
  if (shape == 1) p.push_back({"decay", "spans", 0.05, 3.0, 0.4});
  if (shape == 2) {
    p.push_back({"period", "spans", 0.25, 4.0, 1.0});
    p.push_back({"phase", "rad", -7.0, 7.0, 0.0});
  }
  return p;
}

template <double (*Shape)(Input)>
void addShape(std::vector<EffectForm>& all, int shape, std::initializer_list<const char*> names) {
  auto name = names.begin();
  const auto soil = [&](Channel channel, const char* formula, const Target& target, auto act) {
    all.push_back({.name = *name++,
                   .family = "drift",
                   .covariate = "time_s",
                   .channel = channel,
                   .formula = formula,
                   .source = "fredlund_1978",
                   .signature = "every channel drifts with a column",
                   .parameters = shapeParameters(target, shape),
                   .act = act});
  };
  const auto sensor = [&](Channel channel, const char* formula, const Target& target, auto read) {
    all.push_back({.name = *name++,
                   .family = "drift",
                   .covariate = "time_s",
                   .channel = channel,
                   .of_sensor = true,
                   .formula = formula,
                   .source = "ours",
                   .signature = "one channel alone drifts",
                   .parameters = shapeParameters(target, shape),
                   .read = read});
  };
  soil(Channel::DrawbarPull, "c -> c (1 + g(u))", {"-", -0.95, 8.0, 0.3}, cohesion<Shape>);
  soil(Channel::DrawbarPull, "tan phi -> tan phi (1 + g(u))", {"-", -0.8, 3.0, 0.1}, friction<Shape>);
  soil(Channel::Sinkage, "k -> k e^{g(u)}", {"-", -3.0, 3.0, 0.3}, stiffness<Shape>);
  sensor(Channel::DrawbarPull, "DP_m = DP + g(u)", {"N", -300.0, 300.0, 2.0},
         zero<Shape, Channel::DrawbarPull>);
  sensor(Channel::Torque, "T_m = T + g(u)", {"Nm", -30.0, 30.0, 0.2}, zero<Shape, Channel::Torque>);
  sensor(Channel::Sinkage, "z_m = z + g(u)", {"m", -0.05, 0.05, 0.002}, zero<Shape, Channel::Sinkage>);
}

}  // namespace

std::vector<EffectForm> driftEffects() {
  std::vector<EffectForm> all;
  addShape<linear>(all, 0,
                   {"drift_cohesion", "drift_friction", "drift_stiffness", "drift_drawbar_zero",
                    "drift_torque_zero", "drift_sinkage_zero"});
  addShape<relaxing>(
      all, 1,
      {"drift_cohesion_relaxing", "drift_friction_relaxing", "drift_stiffness_relaxing",
       "drift_drawbar_zero_relaxing", "drift_torque_zero_relaxing", "drift_sinkage_zero_relaxing"});
  addShape<wave>(all, 2,
                 {"drift_cohesion_diurnal", "drift_friction_diurnal", "drift_stiffness_diurnal",
                  "drift_drawbar_zero_diurnal", "drift_torque_zero_diurnal", "drift_sinkage_zero_diurnal"});
  return all;
}

namespace {

double passive(const WheelContact& c) {  // Kp = tan^2(45 deg + phi/2)
  const double t = std::tan(0.785398163397448 + 0.5 * std::atan(c.tan_friction));
  return t * t;
}

/// Passive wedge in front of a blade at depth z: frictional and cohesive force [N].
struct Wedge {
  double friction, cohesion;
};

Wedge wedge(const WheelContact& c, double z, double width) {
  const double kp = passive(c), weight = c.density_kg_m3 * c.gravity_m_s2;
  return {width * 0.5 * weight * z * z * kp, width * 2.0 * c.cohesion_Pa * z * std::sqrt(kp)};
}

/// Hegedus' resistance [N] of the front of the wheel, width b, at soil height z.
double hegedusAhead_N(const WheelContact& c, double z) {
  const PushedSoil soil{.cohesion_Pa = c.cohesion_Pa,
                        .tan_friction = c.tan_friction,
                        .weight_N_m3 = c.density_kg_m3 * c.gravity_m_s2};
  return c.width_m * hegedus(soil).resistance_N_m(z);
}

/// Share of the passive pressure in front of the wheel that is mobilised, 1 - e^{-b cot beta / K} (ours):
/// Janosi and Hanamoto's law over the forward travel per wheel width of lateral travel. 1 at beta = 0, 0 at
/// 90 deg.
double mobilised(const WheelState& state, const WheelContact& c) {
  const double ahead = std::max(std::cos(state.slip_angle_rad), 0.0);
  const double across = std::abs(std::sin(state.slip_angle_rad));
  return -std::expm1(-c.width_m * ahead / std::max(across * c.shear_modulus_m, 1e-300));
}

/// Coulomb's passive coefficient of a vertical wall with friction tan delta.
double passiveRough(double tan_friction, double tan_wall) {
  const double phi = std::atan(tan_friction), delta = std::atan(tan_wall);
  const double root = std::sqrt(std::sin(phi + delta) * std::sin(phi) / std::cos(delta));
  const double ratio = std::cos(phi) / std::max(1.0 - root, 0.1);
  return ratio * ratio / std::cos(delta);
}

/// Forces of the soil on the side face of a wheel that slides sideways.
struct FaceForces {
  double push_N;  ///< magnitude, opposite to the sideways motion
  double pull_N;  ///< forward, by wall friction
};

/// Passive pressure and wall friction on the side face. The pushed soil rises along the face as its wedge
/// does, at tan(45 deg - phi/2) times the lateral speed, while the face rotates past at its mean height. Wall
/// friction acts against the resultant of both sliding speeds. Its vertical component increases the passive
/// pressure, its component along the wheel plane is pull_N.
FaceForces faceForces(const WheelContact& c, double z, double slip_angle_rad, double tan_wall) {
  const double along = std::cos(slip_angle_rad) - c.rolling * (1.0 - 0.5 * z / c.radius_m);
  const double up = std::abs(std::sin(slip_angle_rad)) / std::sqrt(passive(c));
  const double slide = std::max(std::hypot(along, up), 1e-12);
  const double kp = passiveRough(c.tan_friction, tan_wall * up / slide);
  const double chord = 2.0 * std::sqrt(std::max(0.0, z * (2.0 * c.radius_m - z)));
  const double weight = c.density_kg_m3 * c.gravity_m_s2;
  const double push = chord * z * (0.5 * weight * z * kp + 2.0 * c.cohesion_Pa * std::sqrt(kp)) *
                      std::abs(std::sin(slip_angle_rad));
  return {push, -tan_wall * push * along / slide};
}

/// Switches off the side bulldozing of the base model, which the effect replaces.
void noBaseBulldozing(Input, WheelContact& c) {
  c.side_bulldozing = 0.0;
}

const EffectForm kForceForms[] = {
    {.name = "bulldozing",
     .family = "bulldozing",
     .covariate = "sinkage_m",
     .channel = Channel::DrawbarPull,
     .formula = "R_b = a b (gamma z^2 Kp / 2 + 2 c z sqrt(Kp))",
     .source = "bekker_1969",
     .signature = "drawbar pull alone falls, between linear and square in sinkage",
     .parameters = {{"a", "-", 0.0, 20.0, 1.0}},
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const Wedge w = wedge(c, std::max(r.sinkage_m, 0.0), c.width_m);
           r.drawbar_pull_N -= in.parameter[0] * (w.friction + w.cohesion) * mobilised(in.state, c);
         }},
    {.name = "bulldozing_two_term",
     .family = "bulldozing",
     .covariate = "sinkage_m",
     .channel = Channel::DrawbarPull,
     .formula = "R_b = b (a_g gamma z^2 Kp / 2 + a_c 2 c z sqrt(Kp))",
     .source = "bekker_1969",
     .signature = "as bulldozing, weights of soil weight and cohesion apart",
     .parameters = {{"a_g", "-", 0.0, 30.0, 1.0}, {"a_c", "-", 0.0, 20.0, 1.0}},
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const Wedge w = wedge(c, std::max(r.sinkage_m, 0.0), c.width_m);
           r.drawbar_pull_N -=
               (in.parameter[0] * w.friction + in.parameter[1] * w.cohesion) * mobilised(in.state, c);
         }},
    {.name = "bulldozing_hegedus",
     .family = "bulldozing",
     .covariate = "sinkage_m",
     .channel = Channel::DrawbarPull,
     .formula = "R_b = a b (cot X + tan(X + phi)) (z c + rho g z^2/2 (cot X + cot^2 X tan phi)), X = 45 "
                "deg - phi/2",
     .source = "hegedus_1960",
     .signature = "as bulldozing",
     .parameters = {{"a", "-", 0.0, 20.0, 1.0}},
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           r.drawbar_pull_N -=
               in.parameter[0] * hegedusAhead_N(c, std::max(r.sinkage_m, 0.0)) * mobilised(in.state, c);
         }},
    {.name = "bulldozing_ahead",
     .family = "bulldozing",
     .covariate = "sinkage_m",
     .channel = Channel::DrawbarPull,
     .formula = "R_b = a b gamma z_p^2 Kp / 2 of a heap without cohesion, z_p = z less what a driven wheel "
                "dug; times 1 - e^{-b cot beta / K}",
     .source = "bekker_1969",
     .signature = "as bulldozing, but not of a wheel that throws the soil behind itself",
     .parameters = {{"a", "-", 0.0, 20.0, 1.0}},
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const Wedge w = wedge(c, std::max(r.sinkage_m - r.dug_m, 0.0), c.width_m);
           r.drawbar_pull_N -= in.parameter[0] * w.friction * mobilised(in.state, c);
         }},
    {.name = "side_bulldozing",
     .family = "lateral_slip",
     .covariate = "slip_angle_rad",
     .channel = Channel::SideForce,
     .formula =
         "F -= a sin beta l z (gamma z Kp/2 + 2 c sqrt(Kp)), l = 2 r sin theta_1, in place of the base's",
     .source = "ishigami_2007",
     .signature = "side force grows with slip angle and sinkage",
     .parameters = {{"a", "-", 0.0, 20.0, 1.0}},
     .act = noBaseBulldozing,
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const double z = std::max(r.sinkage_m, 0.0);
           const double chord = 2.0 * std::sqrt(std::max(0.0, z * (2.0 * c.radius_m - z)));
           const Wedge w = wedge(c, z, chord);
           r.side_force_N -= in.parameter[0] * (w.friction + w.cohesion) * std::sin(in.x);
         }},
    {.name = "side_bulldozing_rough",
     .family = "lateral_slip",
     .covariate = "slip_angle_rad",
     .channel = Channel::SideForce,
     .formula =
         "F -= a F_p(Kp(mu t_z)) sin beta, DP -= a mu |F_p sin beta| t_x, F_p as side_bulldozing with "
         "Coulomb's Kp; (t_x, t_z) along (cos beta - (1 - z/2r) r omega/v, sin beta tan(45 deg - phi/2))",
     .source = "ours",
     .signature =
         "side force grows with slip angle and sinkage and falls where the wheel spins, drawbar pull "
         "rises there and falls where it is braked",
     .parameters = {{"a", "-", 0.0, 20.0, 1.0}, {"mu", "-", 0.0, 1.0, 0.3}},
     .act = noBaseBulldozing,
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const FaceForces face = faceForces(c, std::max(r.sinkage_m, 0.0), in.x, in.parameter[1]);
           r.side_force_N -= in.parameter[0] * std::copysign(face.push_N, in.x);
           r.drawbar_pull_N += in.parameter[0] * face.pull_N;
         }},
    {.name = "rear_pile",
     .family = "rear_pile",
     .covariate = "slip",
     .channel = Channel::DrawbarPull,
     .formula = "dDP = a W max(0, i - i0)^2",
     .source = "kang_2003",
     .signature = "drawbar pull alone rises, from a slip on, convex",
     .parameters = {{"a", "-", 0.0, 5.0, 0.5}, {"i0", "-", 0.0, 0.8, 0.4}},
     .read =
         [](Input in, const WheelContact&, Reading& r) {
           const double over = std::max(0.0, in.x - in.parameter[1]);
           r.drawbar_pull_N += in.parameter[0] * r.load_N * over * over;
         }},
    {.name = "rear_pile_passive",
     .family = "rear_pile",
     .covariate = "slip",
     .channel = Channel::DrawbarPull,
     .formula = "dDP = gamma b h^2 Kp / 2, h = h1 max(0, i - i0)",
     .source = "ours",
     .signature = "as rear_pile, but not in proportion to load",
     .parameters = {{"h1", "m", 0.0, 1.0, 0.05}, {"i0", "-", 0.0, 0.8, 0.2}},
     .read =
         [](Input in, const WheelContact& c, Reading& r) {
           const double h = in.parameter[0] * std::max(0.0, in.x - in.parameter[1]);
           r.drawbar_pull_N += wedge(c, h, c.width_m).friction;
         }},
    {.name = "slope_weight_component",
     .family = "load_transfer",
     .covariate = "slope_rad",
     .channel = Channel::DrawbarPull,
     .formula = "DP -= a W sin alpha",
     .source = "iagnemma_dubowsky_2004",
     .signature = "drawbar pull alone, odd in slope",
     .parameters = {{"a", "-", -1.5, 1.5, 0.5}},
     .read = [](Input in, const WheelContact&,
                Reading& r) { r.drawbar_pull_N -= in.parameter[0] * r.load_N * std::sin(in.x); }},
};

}  // namespace

std::vector<EffectForm> forceEffects() {
  return {std::begin(kForceForms), std::end(kForceForms)};
}

namespace {

double turning(const WheelState& state) {
  return state.slip > -1.0 ? 1.0 : 0.0;
}

const EffectForm kSensorForms[] = {
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
    {.name = "load_cell_tilt",
     .family = "load_cell_tilt",
     .covariate = "constant",
     .channel = Channel::DrawbarPull,
     .formula = "DP_m = DP cos e + W sin e",
     .source = "ours",
     .signature = "a constant offset of DP/W alone",
     .parameters = {{"e", "rad", -0.35, 0.35, 0.02}},
     .read =
         [](Input in, const WheelContact&, Reading& r) {
           const double e = in.parameter[0];
           r.drawbar_pull_N = r.drawbar_pull_N * std::cos(e) + r.load_N * std::sin(e);
         }},
    {.name = "drawbar_zero",
     .family = "load_cell_tilt",
     .covariate = "load_N",
     .channel = Channel::DrawbarPull,
     .formula = "DP_m = DP + F0",
     .source = "ours",
     .signature = "DP/W alone, as 1/W",
     .parameters = {{"F0", "N", -500.0, 500.0, 1.0}},
     .read = [](Input in, const WheelContact&, Reading& r) { r.drawbar_pull_N += in.parameter[0]; }},
    {.name = "sinkage_datum",
     .family = "sinkage_datum",
     .covariate = "constant",
     .channel = Channel::Sinkage,
     .formula = "z_m = z + z0",
     .source = "ours",
     .signature = "a constant offset of the sinkage alone",
     .parameters = {{"z0", "m", -0.05, 0.05, 0.002}},
     .read = [](Input in, const WheelContact&, Reading& r) { r.sinkage_m += in.parameter[0]; }},
    {.name = "slip_bias",
     .family = "slip_bias",
     .covariate = "slip",
     .channel = Channel::DrawbarPull,
     .formula = "1 - i = (1 - i_m)/(1 + e)",
     .source = "ours",
     .signature = "every channel, where it is steep in slip (low slip)",
     .parameters = {{"e", "-", -0.3, 0.3, 0.05}},
     .act = [](Input in, WheelContact& c) {
       if (c.slip >= 0.0) c.slip = std::fmax(-0.9, 1.0 - (1.0 - c.slip) / (1.0 + in.parameter[0]));
     }}};

}  // namespace

std::vector<EffectForm> sensorEffects() {
  std::vector<EffectForm> all{std::begin(kSensorForms), std::end(kSensorForms)};
  for (EffectForm& form : all) form.of_sensor = true;
  return all;
}

}  // namespace talus::terramech::detail
