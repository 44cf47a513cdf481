#include "blind_worlds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blind_truth.hpp"

namespace talus::blind {
namespace {

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

/// Design of a campaign.
struct Design {
  int count = 100;
  bool levels = false;
  double one_slip = -1.0;   ///< >= 0: slip of all rows
  bool tied_speed = false;  ///< the travel speed is fixed, so that the rim speed follows from the slip
  bool both_speeds = false;
  int rows_a_run = 0;       ///< > 0: rows in a run
  double run_offset = 0.0;  ///< standard deviation of the offset of a run in drawbar pull DP/W and sinkage
                            ///< z/r
  int idle_columns = 0;     ///< number of columns without an effect
  bool heavy_tails = false;
  bool campaign = false;
  double absolute = 0.0;  ///< noise of drawbar pull DP/W and torque T/(rW) independent of the reading
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
  c.temperature = 15.0 + 8.0 * std::sin(2.0 * std::numbers::pi * c.time / 5000.0) + 2.0 * random.normal();
  c.dust = random.uniform(0.0, 1.0);
  c.battery = 24.0 + random.uniform(0.0, 4.0);
  c.radius = design.campaign ? std::array{0.1, 0.125, 0.15}[static_cast<std::size_t>(random.below(3))] : 0.1;
  c.width = design.campaign ? 0.1 + 0.025 * random.below(3) : 0.1;
  return c;
}

/// Conditions of a row in a run with given wheel, load, speed, pass and slope.
Conditions within(Conditions run, const Conditions& row) {
  for (const auto own : {&Conditions::slip, &Conditions::time, &Conditions::temperature, &Conditions::dust,
                         &Conditions::battery})
    run.*own = row.*own;
  run.rim = run.speed / (1.0 - run.slip);
  return run;
}

double shock(Random& random, const Design& design) {
  if (!design.heavy_tails) return random.normal();
  double chi2 = 0.0;  // Student's t with five degrees of freedom, scaled to unit variance
  for (int k = 0; k < 5; ++k) chi2 += std::pow(random.normal(), 2);
  return random.normal() / std::sqrt(chi2 / 5.0) * std::sqrt(3.0 / 5.0);
}

/// Offsets common to the rows of one run.
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
  // Slip is computed from the two speeds; if both are columns, the speed over ground has the same error.
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

/// True if an effect can be identified with the design of a campaign.
bool shows(const Hidden& h, const Design& design) {
  const auto on = [&](const char* column) {
    return std::find(h.covariates.begin(), h.covariates.end(), column) != h.covariates.end();
  };
  return !(design.one_slip >= 0.0 && on("slip")) && !(design.tied_speed && on("speed_mps"));
}

/// Adds columns without an effect: white noise, random walks or steps.
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

/// Adds for each effect a column correlated with the effect's own column.
void addTied(World& w, Random& random) {
  for (std::size_t h = 0; h < w.hidden.size(); ++h) {
    const std::string& own = w.hidden[h].covariates.front();
    const auto at =
        static_cast<std::size_t>(std::find(w.columns.begin(), w.columns.end(), own) - w.columns.begin());
    const double factor = random.uniform(0.5, 2.0), offset = random.uniform(0.0, 10.0);
    w.columns.push_back("tied_" + std::to_string(h));
    for (auto* rows : {&w.rows, &w.held})
      for (auto& row : *rows) row.push_back(at < row.size() ? offset + factor * row[at] : random.normal());
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
  Design design = plan.campaign ? campaignDesign(random)
                  : plan.wide   ? wideDesign(random)
                                : plainDesign(random);
  if (plan.unresolvable == "few") design.rows_a_run = 1, design.count = 8;
  if (plan.unresolvable == "patch")
    w.hidden = {{"patch", "empirical", {"time_s"}, {kPull, kSink, kTorque}, 0.8}};
  if (plan.sites) w.hidden = {{"another_soil", "empirical", {"site"}, {kPull, kSink, kTorque}, 0.8}};
  for (Hidden& h : w.hidden)
    while (!shows(h, design)) h = draw(plan.library ? libraryKinds() : otherKinds(), random);
  if (design.tied_speed)  // the two columns cannot be distinguished
    for (Hidden& h : w.hidden)
      if (std::find(h.covariates.begin(), h.covariates.end(), "slip") != h.covariates.end())
        h.covariates.push_back("rim_speed_mps");
  if (plan.product && plan.seed % 2 == 0)
    w.hidden = {{"form:pull_dust_temperature", "empirical", {"temperature_C*dust_index"}, {kPull}, -0.12}};
  else if (plan.product)
    w.hidden = {{"form:torque_dust_load", "empirical", {"dust_index*load_N"}, {kTorque}, 0.15}};
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
        const bool other =
            plan.sites ? w.run.back() % 3 == 2 : plan.unresolvable == "patch" && 3 * row >= 2 * design.count;
        if (other) run.strength = 0.8, run.stiffness = 0.6;
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
    // The noise floor: residual of the true model at the measured slip and load.
    Conditions seen = c;
    seen.slip = w.held.back()[0];
    seen.load = w.held.back()[1];
    const Answer best = truth(w, seen);
    w.floor_pull.push_back((w.held.back()[4] - best.pull) / seen.load);
    w.floor_z.push_back((w.held.back()[3] - best.z) / c.radius);
  }
  if (!plan.wide && !plan.campaign) {  // the rim speed follows from speed and slip
    const auto at = std::find(w.columns.begin(), w.columns.end(), "rim_speed_mps") - w.columns.begin();
    w.columns.erase(w.columns.begin() + at);
    for (auto* rows : {&w.rows, &w.held})
      for (auto& row : *rows) row.erase(row.begin() + at);
  }
  if (plan.unresolvable == "tied") addTied(w, random);
  std::vector<std::string> held_columns = w.columns;
  addIdleColumns(design, held_columns, w.held, random);
  addIdleColumns(design, w.columns, w.rows, random);
  return w;
}

}  // namespace talus::blind
