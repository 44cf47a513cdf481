#include <algorithm>
#include <cmath>

#include <terramech/effects.hpp>

namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;
constexpr double kGravity = 9.80665;  // the tests of the literature were made on Earth

double passive(const WheelContact& c) {  // Kp = tan^2(45 deg + phi/2)
  const double t = std::tan(0.785398163397448 + 0.5 * std::atan(c.tan_friction));
  return t * t;
}

/// Passive wedge in front of a blade of height z: frictional and cohesive part [N].
struct Wedge {
  double friction, cohesion;
};

Wedge wedge(const WheelContact& c, double z, double width) {
  const double kp = passive(c), weight = c.density_kg_m3 * kGravity;
  return {width * 0.5 * weight * z * z * kp, width * 2.0 * c.cohesion_Pa * z * std::sqrt(kp)};
}

/// Hegedus' resistance of a vertical blade of height z, a' = 0, X = 45 deg - phi/2 [N].
double hegedus(const WheelContact& c, double z) {
  const double phi = std::atan(c.tan_friction), x = 0.785398163397448 - 0.5 * phi;
  const double cot_x = 1.0 / std::tan(x), front = cot_x + std::tan(x + phi);
  const double tan_phi = std::max(c.tan_friction, 1e-3);
  const double heap = cot_x + cot_x * cot_x * tan_phi;
  return c.width_m * front * (z * c.cohesion_Pa + 0.5 * c.density_kg_m3 * kGravity * z * z * heap);
}

double direction(const WheelState& state) {
  return intoTheSoil(state.slip_angle_rad);
}

std::vector<EffectForm> bulldozing() {
  return {
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
             r.drawbar_pull_N -= in.parameter[0] * (w.friction + w.cohesion) * direction(in.state);
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
                 (in.parameter[0] * w.friction + in.parameter[1] * w.cohesion) * direction(in.state);
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
                 in.parameter[0] * hegedus(c, std::max(r.sinkage_m, 0.0)) * direction(in.state);
           }},
      {.name = "side_bulldozing",
       .family = "lateral_slip",
       .covariate = "slip_angle_rad",
       .channel = Channel::SideForce,
       .formula = "F -= a sin beta l z (gamma z Kp/2 + 2 c sqrt(Kp)), l = 2 r sin theta_1",
       .source = "ishigami_2007",
       .signature = "side force grows with slip angle and sinkage",
       .parameters = {{"a", "-", 0.0, 20.0, 1.0}},
       .read =
           [](Input in, const WheelContact& c, Reading& r) {
             const double z = std::max(r.sinkage_m, 0.0);
             const double chord = 2.0 * std::sqrt(std::max(0.0, z * (2.0 * c.radius_m - z)));
             const Wedge w = wedge(c, z, chord);
             r.side_force_N -= in.parameter[0] * (w.friction + w.cohesion) * std::sin(in.x);
           }},
  };
}

std::vector<EffectForm> pile() {
  return {
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
  };
}

std::vector<EffectForm> weight() {
  return {
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
}

}  // namespace

std::vector<EffectForm> forceEffects() {
  std::vector<EffectForm> all;
  for (auto part : {bulldozing, pile, weight})
    for (EffectForm& form : part()) all.push_back(std::move(form));
  return all;
}

}  // namespace talus::terramech::detail
