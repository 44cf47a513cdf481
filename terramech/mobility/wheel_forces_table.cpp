#include <cmath>
#include <limits>
#include <stdexcept>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>

namespace talus::terramech {

Soil rutted(const Soil& soil) {
  Soil rut = soil;
  rut.cohesive_modulus *= soil.rut_stiffness;
  rut.frictional_modulus *= soil.rut_stiffness;
  rut.shear_modulus_m /= std::sqrt(soil.rut_stiffness);
  return rut;
}

RefinedModel onSoil(const Soil& soil) {
  RefinedModel model;
  model.soil = soil;
  return model;
}

void requireForces(const RefinedModel& model) {
  validate(model.soil);
  if (model.base == BaseModel::LinearFormula)
    throw std::invalid_argument(
        "model 'linear-formula' computes drawbar pull from a measured torque and cannot predict slip on a "
        "slope; trace the data with model: wong-reece");
}

RefinedModel rutted(const RefinedModel& model) {
  RefinedModel rut = model;
  if (!knowsPasses(model.effects)) rut.soil = rutted(model.soil);
  return rut;
}

namespace {

constexpr double kRightAngle = 1.5707963267948966;
// Loads of the table, relative to the even load. The range covers load transfer in pitch and roll, up to a
// corner wheel of an eight-wheeled rover near tip-over, and steep planes.
constexpr std::array<double, WheelForcesTable::kLoads> kLoadShares{0.2, 0.6, 1.2, 2.4, 4.8};

using Node = std::array<double, kWheelChannels>;

Node ratios(const WheelForces& f, double load_N, double radius_m) {
  return {f.drawbar_pull_N / load_N, f.side_force_N / load_N, f.torque_Nm / (load_N * radius_m),
          f.sinkage_m / radius_m};
}

/// Forces of a wheel that the soil cannot carry: the wheel is sunk to its axle, sinkage over radius 1.
Node onAxle(const Soil& soil, const Rover& rover, const WheelMotion& m) {
  const ImposedContact at = forcesAtEntry(
      soil, rover.wheel,
      {.slip = m.slip, .slip_angle_rad = m.slip_angle_rad, .gravity_m_s2 = rover.gravity_m_s2}, kRightAngle);
  Node node = ratios(at.forces, std::max(at.load_N, 1e-6 * m.load_N), rover.wheel.radius_m);
  node[kSinkageRatio] = 1.0;
  return node;
}

/// Weights of the four nodes around a point of an even grid and their derivatives per step, by Catmull and
/// Rom's cubic; the grid is extrapolated linearly at its ends.
struct CubicWeights {
  int first;
  std::array<double, 4> value, slope;
};

CubicWeights cubic(double position, int nodes) {
  const int cell = std::clamp(static_cast<int>(position), 0, nodes - 2);
  const double t = std::clamp(position - cell, 0.0, 1.0), t2 = t * t, t3 = t2 * t;
  CubicWeights w{cell - 1,
                 {0.5 * (-t + 2.0 * t2 - t3), 0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
                  0.5 * (t + 4.0 * t2 - 3.0 * t3), 0.5 * (t3 - t2)},
                 {0.5 * (-1.0 + 4.0 * t - 3.0 * t2), 0.5 * (-10.0 * t + 9.0 * t2),
                  0.5 * (1.0 + 8.0 * t - 9.0 * t2), 0.5 * (3.0 * t2 - 2.0 * t)}};
  const auto fold = [&](int outside, int near, int next) {  // f_out = 2 f_near - f_next
    for (auto* part : {&w.value, &w.slope}) {
      const double share = (*part)[static_cast<std::size_t>(outside)];
      (*part)[static_cast<std::size_t>(outside)] = 0.0;
      (*part)[static_cast<std::size_t>(near)] += 2.0 * share;
      (*part)[static_cast<std::size_t>(next)] -= share;
    }
  };
  if (cell == 0) fold(0, 1, 2);
  if (cell == nodes - 2) fold(3, 2, 1);
  return w;
}

/// Weights of Lagrange's polynomial in the logarithm of the load.
std::array<double, WheelForcesTable::kLoads> loadWeights(double share) {
  static const std::array<double, WheelForcesTable::kLoads> logs = [] {
    std::array<double, WheelForcesTable::kLoads> l{};
    for (std::size_t k = 0; k < l.size(); ++k) l[k] = std::log(kLoadShares[k]);
    return l;
  }();
  const double x = std::log(std::clamp(share, kLoadShares.front(), kLoadShares.back()));
  std::array<double, WheelForcesTable::kLoads> weights{};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = 1.0;
    for (std::size_t j = 0; j < weights.size(); ++j)
      if (j != k) weights[k] *= (x - logs[j]) / (logs[k] - logs[j]);
  }
  return weights;
}

}  // namespace

std::vector<WheelMotion> WheelForcesTable::motions(double even_load_N) {
  std::vector<WheelMotion> all;
  for (const double share : kLoadShares)
    for (int a = 0; a < kAngles; ++a)
      for (int s = 0; s < kSlips; ++s) all.push_back({share * even_load_N, slipOf(s), angleOf(a)});
  return all;
}

WheelForcesTable::WheelForcesTable(const RefinedModel& model, const Rover& rover, int pass)
    : even_load_N_(wheelLoad_N(rover)) {
  requireForces(model);
  validate(rover);
  RefinedModel ground = withoutSensors(model);
  ground.slip_along_travel = false;
  const std::vector<WheelMotion> all = motions(even_load_N_);
  std::vector<Node> nodes;
  if (ground.effects.empty()) {
    std::vector<WheelCase> cases;
    for (const WheelMotion& m : all)
      cases.push_back(wheelCase(ground.soil, rover.wheel,
                                {.load_N = m.load_N,
                                 .slip = m.slip,
                                 .slip_angle_rad = m.slip_angle_rad,
                                 .gravity_m_s2 = rover.gravity_m_s2}));
    std::vector<WheelForces> forces(cases.size());
    equilibria(cases, forces);
    for (std::size_t k = 0; k < all.size(); ++k)
      nodes.push_back(std::isfinite(forces[k].sinkage_m)
                          ? ratios(forces[k], all[k].load_N, rover.wheel.radius_m)
                          : onAxle(ground.soil, rover, all[k]));
  } else {
    std::vector<WheelState> states;
    for (const WheelMotion& m : all) {
      states.push_back(steadyWheel(rover, m.load_N, m.slip, m.slip_angle_rad));
      states.back().pass_index = pass;
    }
    SolvedContacts solved;
    for (const Reading& r : predict(ground, states, solved))
      nodes.push_back({r.drawbar_pull_N / r.load_N, r.side_force_N / r.load_N,
                       r.torque_Nm / (r.load_N * r.radius_m), std::min(r.sinkage_m / r.radius_m, 1.0)});
  }
  tabulate(nodes);
}

void WheelForcesTable::tabulate(const std::vector<Node>& nodes) {
  const auto add = [&](std::size_t load, std::size_t angle, double side_sign) {
    for (std::size_t s = 0; s < kSlips; ++s) {
      Node node = nodes[(load * kAngles + angle) * kSlips + s];
      node[kSideRatio] *= side_sign;
      nodes_.insert(nodes_.end(), node.begin(), node.end());
    }
  };
  for (std::size_t l = 0; l < kLoads; ++l) {
    add(l, 1, -1.0);  // mirror image of the first angle, before 0
    for (std::size_t a = 0; a < kAngles; ++a) add(l, a, 1.0);
  }
  const auto weights = loadWeights(1.0);
  even_.resize(kAngles * kSlips * kWheelChannels, 0.0);
  const std::size_t row = kSlips * kWheelChannels, table = nodes_.size() / kLoads;
  for (std::size_t l = 0; l < kLoads; ++l)
    for (std::size_t k = 0; k < even_.size(); ++k) even_[k] += weights[l] * nodes_[l * table + row + k];
}

WheelRatios WheelForcesTable::at(const WheelMotion& motion) const noexcept {
  const CubicWeights slip = cubic((motion.slip + 1.0) / kSlipStep, kSlips);
  const double size = std::abs(motion.slip_angle_rad);
  const CubicWeights angle = cubic(size / kAngleStep_rad + 1.0, kAngles + 1);
  const auto loads = loadWeights(motion.load_N / even_load_N_);
  const std::size_t table = nodes_.size() / kLoads;
  WheelRatios out;
  for (int a = 0; a < 4; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (angle.value[i] == 0.0 && angle.slope[i] == 0.0) continue;
    for (int s = 0; s < 4; ++s) {
      const auto j = static_cast<std::size_t>(s);
      if (slip.value[j] == 0.0 && slip.slope[j] == 0.0) continue;
      const auto node =
          static_cast<std::size_t>(((angle.first + a) * kSlips + slip.first + s) * kWheelChannels);
      for (std::size_t c = 0; c < kWheelChannels; ++c) {
        double f = 0.0;
        for (std::size_t l = 0; l < kLoads; ++l) f += loads[l] * nodes_[l * table + node + c];
        out.value[c] += angle.value[i] * slip.value[j] * f;
        out.by_slip[c] += angle.value[i] * slip.slope[j] * f;
        out.by_angle[c] += angle.slope[i] * slip.value[j] * f;
      }
    }
  }
  const double sign = motion.slip_angle_rad < 0.0 ? -1.0 : 1.0;
  for (std::size_t c = 0; c < kWheelChannels; ++c) {
    out.by_slip[c] /= kSlipStep;
    out.by_angle[c] *= sign / kAngleStep_rad;
  }
  out.value[kSideRatio] *= sign;
  out.by_slip[kSideRatio] *= sign;
  out.by_angle[kSideRatio] *= sign;
  return out;
}

}  // namespace talus::terramech
