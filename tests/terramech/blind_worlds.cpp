#include "blind_worlds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus::blind {
namespace {

constexpr double kPi = 3.14159265358979;

struct Conditions {
  double load, slip, speed, rim, pass, time, slope, grouser, temperature, dust, battery, radius, width;
  double strength = 1.0, stiffness = 1.0;  // of the soil there, over that of the world
};

struct Answer {
  double z, torque, pull;
};

struct Wheel {
  double n, k, c, t, K, c1, c2, r, b, rs, kappa = 0.0, hard = 1e9, hard_k = 0.0;
};

struct Integral {
  double w = 0.0, t = 0.0, d = 0.0;
};

Integral integrate(const Wheel& m, double slip, double entry) {
  const double peak = std::clamp(m.c1 + m.c2 * slip, 0.05, 0.95) * entry;
  const double exit = -std::acos(1.0 - m.kappa * (1.0 - std::cos(entry)));
  constexpr int kSteps = 200;  // half of them either side of the peak
  Integral sum;
  for (int i = 0; i < kSteps; ++i) {
    const bool rear = i < kSteps / 2;
    const double v = (2.0 * (rear ? i : i - kSteps / 2) + 1.0) / kSteps;
    const double u =
        rear ? v * v * v : 1.0 - (1.0 - v) * (1.0 - v) * (1.0 - v);  // fine where the stress begins
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
  const double t = std::tan(kPi / 4.0 + 0.5 * std::atan(tan_phi));
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
    for (int i = 0; i < 40; ++i) {  // softer ground until it carries the load there
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
  if (has(world, "form:pull_speed_peak", a))
    out.pull += at.load * a * std::exp(-std::pow(std::log(at.speed / 0.05) / 0.4, 2));
  return out;
}

struct Kind {
  const char *kind, *family;
  std::vector<std::string> covariates, channels;
  double low, high;
};

const std::string kPull = "drawbar_pull_over_load", kSink = "sinkage_over_radius",
                  kTorque = "torque_over_load_radius";

const std::vector<Kind>& libraryKinds() {
  static const std::vector<Kind> kinds{
      {"slip_sinkage_ding", "slip_sinkage", {"slip"}, {kPull, kSink, kTorque}, 0.2, 0.6},
      {"slip_sinkage_lyasko", "slip_sinkage", {"slip"}, {kPull, kSink, kTorque}, 1.0, 1.0},
      {"bulldozing", "bulldozing", {"sinkage_m"}, {kPull}, 0.7, 1.5},
      {"rear_pile", "rear_pile", {"slip"}, {kPull}, 0.4, 1.0},
      {"rate_pressure", "rate", {"speed_mps"}, {kSink, kPull, kTorque}, 0.08, 0.2},
      {"rate_shear", "rate", {"speed_mps"}, {kPull, kTorque, kSink}, 0.06, 0.15},
      {"multipass", "multipass", {"pass_index"}, {kSink, kPull, kTorque}, 0.3, 0.8},
      {"rebound", "rebound", {"sinkage_m", "load_N"}, {kSink, kPull, kTorque}, 0.08, 0.25},
      {"hardpan", "hardpan", {"sinkage_m", "load_N"}, {kSink, kPull, kTorque}, 1e7, 5e7},
      {"grouser_radius", "grouser", {"grouser_height_m"}, {kTorque, kPull, kSink}, 0.6, 1.0},
      {"load_transfer", "load_transfer", {"slope_rad"}, {kSink, kPull, kTorque}, 0.3, 0.6},
      {"flexibility", "wheel_flexibility", {"load_N"}, {kSink, kPull, kTorque}, 0.1, 0.3},
      {"torque_offset", "torque_sensor", {"load_N", "constant"}, {kTorque}, 0.3, 0.8},
      {"load_cell_tilt", "load_cell_tilt", {"constant"}, {kPull}, 0.02, 0.05},
      {"sinkage_datum", "sinkage_datum", {"constant"}, {kSink}, 0.0015, 0.005},
      {"drift_cohesion", "drift", {"time_s"}, {kPull, kTorque, kSink}, 0.4, 1.0},
      {"slip_bias", "slip_bias", {"slip"}, {kPull, kTorque, kSink}, 0.05, 0.12},
  };
  return kinds;
}

const std::vector<Kind>& otherKinds() {
  static const std::vector<Kind> kinds{
      {"form:pull_slip_bump", "empirical", {"slip"}, {kPull}, 0.06, 0.15},
      {"form:sinkage_temperature_step", "empirical", {"temperature_C"}, {kSink}, 0.03, 0.08},
      {"form:torque_battery_parabola", "empirical", {"battery_V"}, {kTorque}, 0.06, 0.15},
      {"form:pull_dust_saturating", "empirical", {"dust_index"}, {kPull}, -0.12, -0.05},
      {"form:pull_speed_peak", "empirical", {"speed_mps"}, {kPull}, 0.06, 0.12},
      {"form:stiffness_sine_dust", "empirical", {"dust_index"}, {kSink, kPull, kTorque}, 0.3, 0.5},
  };
  return kinds;
}

Hidden draw(const std::vector<Kind>& kinds, Random& random) {
  const Kind& k = kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
  return {k.kind, k.family, k.covariates, k.channels, random.uniform(k.low, k.high)};
}

/// How a campaign was laid out.
struct Design {
  int count = 100;
  bool levels = false;
  double one_slip = -1.0;   ///< >= 0: all rows have it
  bool tied_speed = false;  ///< the travel speed is fixed, so that the rim's follows the slip
  bool both_speeds = false;
  int rows_a_run = 0;       ///< > 0: runs
  double run_offset = 0.0;  ///< of DP/W and z/r, normal from run to run
  int idle_columns = 0;     ///< that mean nothing
  bool heavy_tails = false;
  bool campaign = false;
  double absolute = 0.0;  ///< part of the noise that does not grow with the reading, of DP/W and T/(rW)
};

Design plainDesign(Random& random) {
  Design d;
  d.count = 60 + random.below(341);
  d.levels = random.below(2) == 1;
  return d;
}

Design wideDesign(Random& random) {
  Design d = plainDesign(random);
  const int kind = random.below(5);
  if (kind == 1) d.one_slip = random.uniform(0.15, 0.5);
  if (kind == 2) d.tied_speed = true;
  if (kind == 3) {
    d.rows_a_run = 4 + random.below(9);
    d.run_offset = random.uniform(0.003, 0.015);
  }
  d.both_speeds = true;
  d.idle_columns = random.below(5);
  d.heavy_tails = random.below(3) == 0;
  d.absolute = random.below(2) * random.uniform(0.002, 0.01);
  return d;
}

Design campaignDesign(Random& random) {
  const int runs = 12 + random.below(14), rows = 6 + random.below(15);
  return {
      .count = runs * rows, .both_speeds = true, .rows_a_run = rows, .run_offset = 0.003, .campaign = true};
}

Conditions conditions(Random& random, int row, const Design& design) {
  static constexpr double kLoads[] = {20.0, 40.0, 60.0, 90.0}, kSlips[] = {0.05, 0.15, 0.3, 0.45, 0.6, 0.8};
  Conditions c{};
  c.load = design.levels ? kLoads[random.below(4)] : random.uniform(20.0, 100.0);
  c.slip = design.levels ? kSlips[random.below(6)] : random.uniform(0.03, 0.8);
  if (design.one_slip >= 0.0) c.slip = design.one_slip;
  c.speed = std::exp(random.uniform(std::log(0.01), std::log(0.15)));
  if (design.tied_speed) c.speed = 0.02;
  c.rim = c.speed / (1.0 - c.slip);
  c.pass = 1.0 + random.below(4);
  c.time = 3600.0 * (row + random.uniform(0.0, 1.0)) / design.count;
  c.slope = random.uniform(-0.25, 0.25);
  c.grouser = random.below(2) * 0.01;
  c.temperature = 15.0 + 8.0 * std::sin(2.0 * kPi * c.time / 5000.0) + 2.0 * random.normal();
  c.dust = random.uniform(0.0, 1.0);
  c.battery = 24.0 + random.uniform(0.0, 4.0);
  c.radius = design.campaign ? std::array{0.1, 0.125, 0.15}[static_cast<std::size_t>(random.below(3))] : 0.1;
  c.width = design.campaign ? 0.1 + 0.025 * random.below(3) : 0.1;
  return c;
}

/// Conditions of a row in a run whose wheel, load, speed, pass and slope are set.
Conditions within(Conditions run, const Conditions& row) {
  for (const auto own : {&Conditions::slip, &Conditions::time, &Conditions::temperature, &Conditions::dust,
                         &Conditions::battery})
    run.*own = row.*own;
  run.rim = run.speed / (1.0 - run.slip);
  return run;
}

double shock(Random& random, const Design& design) {
  if (!design.heavy_tails) return random.normal();
  double chi2 = 0.0;  // Student's t of five degrees, brought to unit variance
  for (int k = 0; k < 5; ++k) chi2 += std::pow(random.normal(), 2);
  return random.normal() / std::sqrt(chi2 / 5.0) * std::sqrt(3.0 / 5.0);
}

/// Offsets that the rows of one run share.
struct RunOffset {
  double pull = 0.0, sinkage = 0.0;
};

std::vector<double> measure(const World& world, const Design& design, const Conditions& c, const Answer& a,
                            const RunOffset& offset, Random& random) {
  const auto noisy = [&](double v, double unit) {
    const double relative = v * (1.0 + world.noise * shock(random, design));
    return design.absolute > 0.0 ? relative + unit * design.absolute * shock(random, design) : relative;
  };
  const double slip = std::clamp(c.slip * (1.0 + world.noise * shock(random, design)), -1.0, 1.0);
  // Slip is had from the two speeds: with both in the table, the one over ground errs with it.
  const double speed = design.both_speeds ? c.rim * (1.0 - slip) : c.speed;
  return {slip,
          c.load * (1.0 + world.noise * shock(random, design)),
          noisy(a.torque, c.load * c.radius),
          noisy(a.z, 0.0) + offset.sinkage * c.radius,
          noisy(a.pull, c.load) + offset.pull * c.load,
          speed,
          c.rim,
          c.pass,
          c.time,
          c.slope,
          c.grouser,
          c.temperature,
          c.dust,
          c.battery,
          c.radius,
          c.width};
}

/// Whether a campaign could show an effect at all.
bool shows(const Hidden& h, const Design& design) {
  const auto on = [&](const char* column) {
    return std::find(h.covariates.begin(), h.covariates.end(), column) != h.covariates.end();
  };
  return !(design.one_slip >= 0.0 && on("slip")) && !(design.tied_speed && on("speed_mps"));
}

/// Columns without meaning: white, wandering or stepping.
void addIdleColumns(const Design& design, std::vector<std::string>& columns,
                    std::vector<std::vector<double>>& rows, Random& random) {
  for (int k = 0; k < design.idle_columns; ++k) {
    columns.push_back("aux_" + std::to_string(k));
    const int kind = random.below(3);
    double walk = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      walk += random.normal();
      rows[row].push_back(kind == 0   ? random.normal()
                          : kind == 1 ? walk
                                      : static_cast<double>((row * 4 / rows.size()) % 2));
    }
  }
}

}  // namespace

World makeWorld(const WorldPlan& plan) {
  Random random{plan.seed};
  World w;
  w.seed = plan.seed;
  w.columns = {"slip",           "load_N",    "torque_Nm",        "sinkage_m",
               "drawbar_pull_N", "speed_mps", "rim_speed_mps",    "pass_index",
               "time_s",         "slope_rad", "grouser_height_m", "temperature_C",
               "dust_index",     "battery_V", "wheel_radius_m",   "wheel_width_m"};
  const double n = random.uniform(0.7, 1.2);
  w.ground = {random.uniform(200.0, 4000.0),
              random.uniform(0.4, 0.65),
              n,
              random.uniform(12e3, 50e3) * std::pow(0.02, 1.0 - n) / 0.02,
              random.uniform(0.01, 0.025),
              random.uniform(0.35, 0.45),
              random.uniform(0.2, 0.35),
              random.uniform(1400.0, 1800.0)};
  w.noise = random.uniform(0.02, 0.05);
  for (int k = 0; k < plan.effects; ++k) {
    Hidden h = draw(plan.library ? libraryKinds() : otherKinds(), random);
    while (!w.hidden.empty() && h.family == w.hidden.front().family &&
           h.covariates == w.hidden.front().covariates)
      h = draw(plan.library ? libraryKinds() : otherKinds(), random);
    w.hidden.push_back(h);
  }
  const Design design = plan.campaign ? campaignDesign(random)
                        : plan.wide   ? wideDesign(random)
                                      : plainDesign(random);
  if (plan.sites) w.hidden = {{"another_soil", "empirical", {"site"}, {kPull, kSink, kTorque}, 0.8}};
  for (Hidden& h : w.hidden)
    while (!shows(h, design)) h = draw(plan.library ? libraryKinds() : otherKinds(), random);
  if (design.tied_speed)  // nobody can tell these apart
    for (Hidden& h : w.hidden)
      if (std::find(h.covariates.begin(), h.covariates.end(), "slip") != h.covariates.end())
        h.covariates.push_back("rim_speed_mps");
  RunOffset offset;
  Conditions run{};
  for (int row = 0; row < design.count; ++row) {
    if (design.rows_a_run > 0) {
      if (row % design.rows_a_run == 0)
        offset = {design.run_offset * random.normal(), design.run_offset * random.normal()};
      w.run.push_back(row / design.rows_a_run);
    }
    Conditions c = conditions(random, row, design);
    if (design.campaign) {
      if (row % design.rows_a_run == 0) {
        run = c;
        if (plan.scatter > 0.0) run.strength = std::max(0.3, 1.0 + plan.scatter * random.normal());
        if (plan.sites && w.run.back() % 3 == 2) run.strength = 0.8, run.stiffness = 0.6;
      }
      c = within(run, c);
      if (plan.sites) w.site.push_back(std::string(1, static_cast<char>('A' + w.run.back() % 3)));
    }
    w.rows.push_back(measure(w, design, c, truth(w, c), offset, random));
  }
  for (int row = 0; row < 80; ++row) {
    Design held = design;
    held.count = 80;
    const Conditions c = conditions(random, row, held);
    const Answer a = truth(w, c);
    w.held.push_back(measure(w, design, c, a, {}, random));
    // The floor: the true model fed with the measured slip and load.
    Conditions seen = c;
    seen.slip = w.held.back()[0];
    seen.load = w.held.back()[1];
    const Answer best = truth(w, seen);
    w.floor_pull.push_back((w.held.back()[4] - best.pull) / seen.load);
    w.floor_z.push_back((w.held.back()[3] - best.z) / c.radius);
  }
  if (!plan.wide && !plan.campaign) {  // the rim's speed follows from speed and slip
    const auto at = std::find(w.columns.begin(), w.columns.end(), "rim_speed_mps") - w.columns.begin();
    w.columns.erase(w.columns.begin() + at);
    for (auto* rows : {&w.rows, &w.held})
      for (auto& row : *rows) row.erase(row.begin() + at);
  }
  std::vector<std::string> held_columns = w.columns;
  addIdleColumns(design, held_columns, w.held, random);
  addIdleColumns(design, w.columns, w.rows, random);
  return w;
}

}  // namespace talus::blind
