#include "blind_truth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::blind {
namespace {

struct Wheel {
  double n, k, c, t, K, c1, c2, r, b, rs, kappa = 0.0, hard = 1e9, hard_k = 0.0;
};

struct Integral {
  double w = 0.0, t = 0.0, d = 0.0;
};

Integral integrate(const Wheel& m, double slip, double entry) {
  const double peak = std::clamp(m.c1 + m.c2 * slip, 0.05, 0.95) * entry;
  const double exit = -std::acos(1.0 - m.kappa * (1.0 - std::cos(entry)));
  constexpr int kSteps = 200;  // half of the steps on either side of the peak
  Integral sum;
  for (int i = 0; i < kSteps; ++i) {
    const bool rear = i < kSteps / 2;
    const double v = (2.0 * (rear ? i : i - kSteps / 2) + 1.0) / kSteps;
    const double u =
        rear ? v * v * v : 1.0 - (1.0 - v) * (1.0 - v) * (1.0 - v);  // finer near the ends of the contact
    const double dv = 3.0 * (rear ? v * v : (1.0 - v) * (1.0 - v));
    const double a = rear ? exit + (peak - exit) * u : peak + (entry - peak) * u;
    const double front = a >= peak ? a : entry - (a - exit) / (peak - exit) * (entry - peak);
    const double h = (rear ? peak - exit : entry - peak) * dv * 2.0 / kSteps;
    const double depth = std::max(0.0, m.r * (std::cos(front) - std::cos(entry)));
    double sigma = m.k * std::pow(depth, m.n);
    if (depth > m.hard) sigma += m.hard_k * (depth - m.hard);
    const double j = m.rs * ((entry - a) - (1.0 - slip) * (std::sin(entry) - std::sin(a)));
    const double tau = (m.c + sigma * m.t) * (1.0 - std::exp(-j / m.K));
    sum.w += h * (sigma * std::cos(a) + tau * std::sin(a));
    sum.t += h * tau;
    sum.d += h * (tau * std::cos(a) - sigma * std::sin(a));
  }
  const double area = m.b * m.r;
  return {sum.w * area, sum.t * area * m.rs, sum.d * area};
}

double entryFor(const Wheel& m, double slip, double load) {
  double low = 1e-4, high = 1.5;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (integrate(m, slip, middle).w < load ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double kp(double tan_phi) {
  const double t = std::tan(std::numbers::pi / 4.0 + 0.5 * std::atan(tan_phi));
  return t * t;
}

bool has(const World& w, const char* kind, double& size) {
  for (const Hidden& h : w.hidden)
    if (h.kind == kind) {
      size = h.size;
      return true;
    }
  return false;
}

}  // namespace

Answer truth(const World& world, const Conditions& at) {
  const Ground& g = world.ground;
  Wheel m{g.n, g.k, g.cohesion, std::tan(g.phi), g.shear_k, g.c1, g.c2, at.radius, at.width, at.radius};
  m.c *= at.strength;
  m.t *= at.strength;
  m.k *= at.stiffness;
  double load = at.load, slip = at.slip, a = 0.0, dig = 1.0;
  if (has(world, "slip_sinkage_ding", a)) m.n += a * slip;
  if (has(world, "slip_sinkage_lyasko", a)) dig = (1.0 + slip) / (1.0 - 0.5 * slip);
  if (has(world, "rate_pressure", a)) m.k *= std::pow(at.speed / 0.03, a);
  if (has(world, "rate_shear", a))
    m.c *= 1.0 + a * std::log(at.speed / 0.03), m.t *= 1.0 + a * std::log(at.speed / 0.03);
  if (has(world, "multipass", a)) {
    const double f = 1.0 + a * (1.0 - std::exp(-(at.pass - 1.0) / 1.3));
    m.k *= f;
    m.c *= f;
  }
  if (has(world, "rebound", a)) m.kappa = a;
  if (has(world, "hardpan", a)) {
    Wheel soft = m;
    m.hard = 0.6 * at.radius * (1.0 - std::cos(entryFor(soft, 0.3, 60.0)));
    m.hard_k = a;
  }
  if (has(world, "grouser_radius", a)) m.rs += a * at.grouser;
  if (has(world, "load_transfer", a)) load *= std::cos(at.slope) - a * std::sin(at.slope);
  if (has(world, "flexibility", a)) m.r *= 1.0 + a * load / 100.0, m.rs *= 1.0 + a * load / 100.0;
  if (has(world, "drift_cohesion", a)) m.c *= std::max(0.0, 1.0 + a * at.time / 3600.0);
  if (has(world, "slip_bias", a)) slip = 1.0 - (1.0 - slip) / (1.0 + a);
  if (has(world, "form:stiffness_sine_dust", a)) m.k *= 1.0 + a * std::sin(at.dust * 6.0);
  double entry = entryFor(m, slip, load);
  if (dig != 1.0) {
    const double z = std::min(0.9 * m.r, dig * m.r * (1.0 - std::cos(entry)));
    entry = std::acos(1.0 - z / m.r);
    for (int i = 0; i < 40; ++i) {  // bisection on the soil's stiffness until the contact carries the load
      const double w = integrate(m, slip, entry).w;
      m.k *= std::pow(load / w, 0.9);
    }
  }
  const Integral f = integrate(m, slip, entry);
  Answer out{m.r * (1.0 - std::cos(entry)), f.t, f.d};
  const double weight = g.density * 9.81, passive = kp(m.t);
  if (has(world, "bulldozing", a))
    out.pull -=
        a * at.width * (0.5 * weight * out.z * out.z * passive + 2.0 * m.c * out.z * std::sqrt(passive));
  if (has(world, "rear_pile", a)) out.pull += a * at.load * std::pow(std::max(0.0, at.slip - 0.35), 2);
  if (has(world, "torque_offset", a)) out.torque += a;
  if (has(world, "load_cell_tilt", a)) out.pull = out.pull * std::cos(a) + at.load * std::sin(a);
  if (has(world, "sinkage_datum", a)) out.z += a;
  if (has(world, "form:pull_slip_bump", a))
    out.pull += at.load * a * std::exp(-std::pow((at.slip - 0.35) / 0.12, 2));
  if (has(world, "form:sinkage_temperature_step", a))
    out.z += at.radius * a / (1.0 + std::exp(-(at.temperature - 15.0) / 2.0));
  if (has(world, "form:torque_battery_parabola", a))
    out.torque += at.load * at.radius * a * std::pow((at.battery - 26.0) / 3.0, 2);
  if (has(world, "form:pull_dust_saturating", a)) out.pull += at.load * a * (1.0 - std::exp(-3.0 * at.dust));
  if (has(world, "form:pull_dust_temperature", a)) out.pull += at.load * a * at.dust * at.temperature / 20.0;
  if (has(world, "form:torque_dust_load", a))
    out.torque += at.load * at.radius * a * at.dust * at.load / 100.0;
  if (has(world, "form:pull_speed_peak", a))
    out.pull += at.load * a * std::exp(-std::pow(std::log(at.speed / 0.05) / 0.4, 2));
  return out;
}

}  // namespace talus::blind
