#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/side_bulldozing.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;

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
  };
}

/// Returns the forms of bulldozing by a wheel that may also dig, brake or slide sideways.
std::vector<EffectForm> pushing() {
  return {
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
  for (auto part : {bulldozing, pushing, pile, weight})
    for (EffectForm& form : part()) all.push_back(std::move(form));
  return all;
}

}  // namespace talus::terramech::detail
