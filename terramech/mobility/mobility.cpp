#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/mobility/steady_wheel.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
/// Load, slip and slope of a wheel.
struct WheelStation {
  double load_N;
  double slip;
  double slope_rad;
};

/// Returns the forces of a wheel; empty if the soil cannot carry it.
using CarriedForces = std::function<std::optional<WheelForces>(const WheelStation&)>;

/// Returns the forces of a wheel sunk to its axle.
using AxleForces = std::function<WheelForces(const WheelStation&)>;

/// Sources of the forces for a mobility curve.
struct MobilitySolver {
  CarriedForces carried;
  AxleForces on_axle;
};

namespace {

/// Steady drive: slope, slip and forces.
struct Drive {
  double slip;
  double slope_rad;
  WheelForces wheel;
};

/// Returns the steady drive at a given slip: DP(i, W cos alpha) = W sin alpha. Solved by fixed-point
/// iteration, because the drawbar pull over load, DP/N, hardly depends on the load N. nullopt if the soil
/// cannot carry the wheel.
std::optional<Drive> driveAt(const CarriedForces& carried, const Rover& rover, double slip) {
  const double weight_N = wheelLoad_N(rover);
  Drive drive{slip, 0.0, {}};
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double load_N = weight_N * std::cos(drive.slope_rad);
    const auto forces = carried({load_N, slip, drive.slope_rad});
    if (!forces) return std::nullopt;
    drive.wheel = *forces;
    const double slope = std::atan(drive.wheel.drawbar_pull_N / load_N);
    const double change = std::abs(slope - drive.slope_rad);
    drive.slope_rad = slope;
    if (change < 1e-10) break;
  }
  return drive;
}

/// Appends drives at the given slips until a slip has no solution. Keeps only drives with a steeper slope
/// than all drives before, uphill (sign 1) or downhill (sign -1).
void follow(const CarriedForces& carried, const Rover& rover, const std::vector<double>& slips, double sign,
            std::vector<Drive>& drives) {
  for (const double slip : slips) {
    const auto drive = driveAt(carried, rover, slip);
    if (!drive) return;
    if (drives.empty() || sign * (drive->slope_rad - drives.back().slope_rad) > 1e-9)
      drives.push_back(*drive);
  }
}

/// Slips of the table: denser close to 0, where the slope changes fastest with slip, and close to 1.
std::vector<double> drivenSlips() {
  std::vector<double> slips;
  for (int k = 0; k <= 40; ++k) slips.push_back(0.5 * (1.0 - std::cos(std::numbers::pi * k / 40.0)));
  return slips;
}

std::vector<double> brakedSlips() {
  std::vector<double> slips;
  for (int k = 0; k <= 32; ++k) slips.push_back(-0.5 * (1.0 - std::cos(std::numbers::pi * k / 32.0)));
  return slips;
}

/// Returns all steady drives in the order of increasing slope.
std::vector<Drive> steadyDrives(const CarriedForces& carried, const Rover& rover) {
  std::vector<Drive> up, down;
  follow(carried, rover, drivenSlips(), 1.0, up);
  follow(carried, rover, brakedSlips(), -1.0, down);
  if (!down.empty()) up.insert(up.begin(), down.rbegin(), down.rend() - 1);
  return up;
}

CarriedForces carriedBy(const Soil& soil, const Wheel& wheel) {
  return [&soil, wheel](const WheelStation& at) -> std::optional<WheelForces> {
    try {
      return equilibrium(soil, wheel, {.load_N = at.load_N, .slip = at.slip});
    } catch (const std::domain_error&) {
      return std::nullopt;
    }
  };
}

/// Returns the prediction of a model for a wheel of a rover at maximum rim speed.
WheelForces predicted(const RefinedModel& model, const Rover& rover, const WheelStation& at, int pass) {
  WheelState state = steadyWheel(rover, at.load_N, at.slip);
  state.pass_index = pass;
  state.slope_rad = at.slope_rad;
  const Reading reading = predict(model, state);
  return {.sinkage_m = reading.sinkage_m,
          .entry_angle_rad = 0.0,
          .torque_Nm = reading.torque_Nm,
          .drawbar_pull_N = reading.drawbar_pull_N};
}

/// Returns the mean torque and pull of consecutive axles, with the sinkage of the first.
WheelForces meanOfAxles(const RefinedModel& model, const Rover& rover, const WheelStation& at,
                        const MobilityOptions& options) {
  WheelForces mean = predicted(model, rover, at, options.first_pass);
  if (!knowsPasses(model.effects)) return mean;
  for (int k = 1; k < options.axles; ++k) {
    const WheelForces f = predicted(model, rover, at, options.first_pass + k);
    mean.torque_Nm += (f.torque_Nm - mean.torque_Nm) / (k + 1);
    mean.drawbar_pull_N += (f.drawbar_pull_N - mean.drawbar_pull_N) / (k + 1);
  }
  return mean;
}

/// Returns the solver of a wheel on a soil; soil and rover must outlive it.
MobilitySolver solverOf(const Soil& soil, const Rover& rover) {
  validate(soil);
  return {carriedBy(soil, rover.wheel), [&](const WheelStation& at) {
            return forcesAtEntry(soil, rover.wheel, {.load_N = at.load_N, .slip = at.slip},
                                 0.5 * std::numbers::pi)
                .forces;
          }};
}

/// Returns a model without sensor errors.
RefinedModel groundOf(const RefinedModel& model) {
  validate(model.soil);
  if (model.base == BaseModel::LinearFormula)
    throw std::invalid_argument(
        "model 'linear-formula' computes drawbar pull from a measured torque and cannot predict slip on a "
        "slope; trace the data with model: wong-reece");
  return withoutSensors(model);
}

/// Returns the solver of the axles of a rover with a model; all arguments must outlive it.
MobilitySolver solverOf(const RefinedModel& ground, const Rover& rover, const MobilityOptions& options) {
  const AxleForces forces = [&](const WheelStation& at) { return meanOfAxles(ground, rover, at, options); };
  return {[&rover, forces](const WheelStation& at) -> std::optional<WheelForces> {
            const WheelForces f = forces(at);
            if (!(f.sinkage_m < (1.0 - 1e-9) * rover.wheel.radius_m)) return std::nullopt;
            return f;
          },
          forces};
}

void require(const Rover& rover, const MobilityOptions& options) {
  validate(rover);
  const RangeCheck check{"mobility options"};
  check.within("reference_slip", options.reference_slip, {1e-6, 1.0 - 1e-6});
  check.within("max_slip", options.max_slip, {1e-6, 1.0});
  check.atLeast("first_pass", options.first_pass, 1.0);
  check.atLeast("axles", options.axles, 1.0);
}

MobilityReference flatAt(const MobilitySolver& solver, const Rover& rover, double slip) {
  const WheelStation flat{wheelLoad_N(rover), slip, 0.0};
  const auto carried = solver.carried(flat);
  const WheelForces f = carried ? *carried : solver.on_axle(flat);
  const double radius_m = rover.wheel.radius_m;
  return {slip, f.drawbar_pull_N / flat.load_N, std::min(f.sinkage_m / radius_m, 1.0),
          f.torque_Nm / (flat.load_N * radius_m)};
}

}  // namespace

MobilityReference mobilityReference(const Soil& soil, const Rover& rover, const MobilityOptions& options) {
  const MobilitySolver solver = solverOf(soil, rover);
  require(rover, options);
  return flatAt(solver, rover, options.reference_slip);
}

MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options) {
  const RefinedModel ground = groundOf(model);
  require(rover, options);
  return flatAt(solverOf(ground, rover, options), rover, options.reference_slip);
}

MobilityCurve::MobilityCurve(const Soil& soil, const Rover& rover, const MobilityOptions& options)
    : rover_(rover), options_(options) {
  tabulate(solverOf(soil, rover));
}

MobilityCurve::MobilityCurve(const RefinedModel& model, const Rover& rover, const MobilityOptions& options)
    : rover_(rover), options_(options) {
  const RefinedModel ground = groundOf(model);
  tabulate(solverOf(ground, rover, options));
}

void MobilityCurve::tabulate(const MobilitySolver& solver) {
  require(rover_, options_);
  reference_ = strongest_ = flatAt(solver, rover_, options_.reference_slip);
  const std::vector<Drive> drives = steadyDrives(solver.carried, rover_);
  if (drives.size() < 2) return;
  std::vector<double> slope, slip, sinkage, torque;
  for (const Drive& drive : drives) {
    slope.push_back(drive.slope_rad);
    slip.push_back(drive.slip);
    sinkage.push_back(drive.wheel.sinkage_m);
    torque.push_back(drive.wheel.torque_Nm);
  }
  min_slope_rad_ = slope.front();
  max_slope_rad_ = slope.back();
  locked_pull_ = std::tan(min_slope_rad_);
  strongest_ = flatAt(solver, rover_, drives.back().slip);
  slip_ = {slope, slip};
  sinkage_m_ = {slope, sinkage};
  torque_Nm_ = {slope, torque};
}

MobilityState MobilityCurve::at(double slope_rad) const noexcept {
  MobilityState state;
  const double demand = std::tan(slope_rad);
  state.drawbar_pull_margin = reference_.drawbar_pull_over_load - demand;
  if (max_slope_rad_ < min_slope_rad_) {
    state.slip = 1.0;
    state.sinkage_m = rover_.wheel.radius_m;
    return state;
  }
  state.drawbar_pull_margin = std::min(state.drawbar_pull_margin, demand - locked_pull_);
  state.slip = slip_.at(slope_rad);
  state.sinkage_m = sinkage_m_.at(slope_rad);
  state.torque_Nm = torque_Nm_.at(slope_rad);
  state.speed_mps = rover_.max_speed_mps * (1.0 - std::max(state.slip, 0.0));
  // P = count T omega + P_hotel with omega = v / (r (1 - i)); braking recovers no energy.
  const double drive_J_per_m = std::max(state.torque_Nm, 0.0) * rover_.wheel_count *
                               (state.slip < 0.0 ? 1.0 + state.slip : 1.0 / (1.0 - state.slip)) /
                               rover_.wheel.radius_m;
  state.energy_J_per_m = drive_J_per_m + rover_.hotel_power_W / state.speed_mps;
  state.feasible = slope_rad >= min_slope_rad_ && slope_rad <= max_slope_rad_ &&
                   state.slip <= options_.max_slip && std::abs(state.torque_Nm) <= rover_.max_torque_Nm;
  return state;
}

}  // namespace talus::terramech
