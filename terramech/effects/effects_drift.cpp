#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech::detail {
namespace {

using Input = const EffectInput&;

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
  switch (channel) {
    case Channel::DrawbarPull:
      r.drawbar_pull_N += Shape(in);
      break;
    case Channel::Sinkage:
      r.sinkage_m += Shape(in);
      break;
    case Channel::Torque:
      r.torque_Nm += Shape(in);
      break;
    case Channel::SideForce:
      r.side_force_N += Shape(in);
      break;
  }
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
                   .formula = formula,
                   .source = "ours",
                   .signature = "one channel alone drifts",
                   .parameters = shapeParameters(target, shape),
                   .read = read,
                   .of_sensor = true});
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

}  // namespace talus::terramech::detail
